// dicot rig tables: the rectification tables of a rig, built once and stored beside its rig file.
#include "distinct_files.h"
#include "rig_commands.h"
#include "stored_maps.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace dicot::app {
namespace {

struct RigTablesWords
{
    std::string rig, output;
    double keep = kCrop;
    bool json = false;
};

nlohmann::json as_json(const RemapTable& table, std::uint32_t checksum)
{
    return {{"cell_px", table.cell_px()},
            {"bytes", table.serial_bytes()},
            {"worst_error_px", table.worst_error_px()},
            {"pixels_with_source", table.pixels_with_source()},
            {"crc32", checksum}};
}

Status run(const RigTablesWords& words)
{
    const std::string path = words.output.empty() ? maps_path(words.rig) : words.output;
    if (!path.ends_with(".maps"))
        return failure(Fault::kUsage, "%s: the name must end in .maps", path.c_str());
    TRY(check_distinct({words.rig}, {path}));
    const RigFile rig = TRY(read_rig_file(words.rig.c_str()));
    const StoredTables stored = TRY(store_tables(rig, words.keep, words.rig, path));
    const RectifyTables& tables = stored.tables;
    if (words.json) {
        const nlohmann::json report = {{"output", path},
                                       {"bytes", stored.bytes},
                                       {"crc32", stored.checksums.whole},
                                       {"keep", words.keep},
                                       {"width", rig.width},
                                       {"height", rig.height},
                                       {"build_ms", tables.milliseconds()},
                                       {"left", as_json(tables.left(), stored.checksums.left)},
                                       {"right", as_json(tables.right(), stored.checksums.right)}};
        std::printf("%s\n", report.dump(2).c_str());
        return {};
    }
    std::printf("%s: %.1f KiB, checksum %08X; %s\n", path.c_str(), static_cast<double>(stored.bytes) / 1024,
                stored.checksums.whole, tables.origin().c_str());
    print_table("left", tables.left());
    std::printf("      checksum %08X\n", stored.checksums.left);
    print_table("right", tables.right());
    std::printf("      checksum %08X\n", stored.checksums.right);
    return {};
}

} // namespace

void add_rig_tables(CLI::App& rig, Command& chosen)
{
    CLI::App* command =
        rig.add_subcommand("tables", "Build the rectification tables and store them beside the rig file");
    auto words = std::make_shared<RigTablesWords>();
    command->add_option("RIG", words->rig, "rig file of the two cameras (YAML)")->required();
    command->add_option("-o,--output", words->output,
                        "tables, .maps (default: the rig file's name with .maps, where process and rectify look)");
    command->add_option("--keep", words->keep, "0 crops until no pixel lacks a source, 1 keeps every source pixel")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
