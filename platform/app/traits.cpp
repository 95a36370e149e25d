// dicot traits: what grew in an archive, as tables, curves and pictures.
#include "commands.h"
#include "distinct_files.h"
#include "output_folder.h"
#include "pull/archive_folder.h"
#include "stop_request.h"
#include "store/shown.h"
#include "store/slot_words.h"
#include "store/store_outcome.h"
#include "traits/traits_csv.h"
#include "traits/traits_json.h"
#include "traits/traits_plots.h"
#include "traits/traits_table.h"
#include "traits/usual_wishes.h"

#include "dicot/os/output_file.h"
#include "dicot/os/thread_crew.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

namespace dicot::app {
namespace {

constexpr const char* kStandardOutput = "-";

struct TraitsWords
{
    std::string archive, device, since, until, csv, plot, cache, timezone, places;
    bool json = false;
    int threads = 0;
};

/// What the boards' outputs are put together in.
struct Report
{
    std::string plant_lines, leaf_lines;
    nlohmann::json boards = nlohmann::json::array();
    std::vector<DrawnPlot> plots;
};

Result<TraitsWishes> wishes_of(const TraitsWords& words)
{
    TraitsWishes wishes = TRY(usual_wishes(words.places));
    wishes.query = TRY(query_between(words.since, words.until));
    wishes.timezone = words.timezone;
    if (!words.cache.empty())
        wishes.cache_folder = words.cache;
    wishes.threads = words.threads > 0 ? words.threads : std::min(ThreadCrew::processors(), 2);
    return wishes;
}

Status report_board(const DeviceFolder& device, const TraitsWords& words, const TraitsWishes& wishes, Report& report)
{
    std::int64_t flawed = 0;
    const BoardTraits board = TRY(measure_board(device, wishes, [&](const Status& flaw) {
        ++flawed;
        std::fprintf(stderr, "dicot: %s\n", flaw.message());
    }));
    const BoardGrowth growth = TRY(board_growth(board, wishes.places));
    if (!words.csv.empty()) {
        report.plant_lines += plant_csv(board, growth);
        report.leaf_lines += leaf_csv(board, growth);
    }
    if (words.json)
        report.boards.push_back(growth_json(board, growth));
    if (!words.plot.empty())
        std::ranges::move(growth_plots(board, growth), std::back_inserter(report.plots));
    if (!words.json && words.csv != kStandardOutput)
        std::printf("%s", growth_words(board, growth).c_str());
    if (flawed > 0)
        return failure(Fault::kBadData, "%s: %s could not be measured: dicot pull --verify takes damaged ones anew",
                       shown(device.path).c_str(), counted(flawed, "snapshot").c_str());
    return {};
}

Status write_file(const std::string& path, const std::string& text)
{
    OutputFile file;
    TRY(file.open(path.c_str()));
    TRY(file.write(text.data(), text.size()));
    return file.commit();
}

/// "growth.leaves.csv" of "growth.csv".
std::string beside_table(const std::string& path)
{
    return (path.ends_with(".csv") ? path.substr(0, path.size() - 4) : path) + ".leaves.csv";
}

/// No table goes over the one of the places, and no two outputs into one another.
Status check_outputs(const TraitsWords& words)
{
    if (words.csv.empty())
        return {};
    if (words.csv != kStandardOutput)
        return check_distinct({words.places}, {words.csv, beside_table(words.csv)});
    return words.json ? failure(Fault::kUsage, "--csv and --json both want standard output: give --csv a FILE")
                      : Status{};
}

/// What cannot be written is said before a season is measured.
Status try_outputs(const TraitsWords& words)
{
    if (!words.csv.empty() && words.csv != kStandardOutput)
        for (const std::string& table : {words.csv, beside_table(words.csv)}) {
            std::error_code unknown;
            if (std::filesystem::is_fifo(table, unknown)) // who reads it would see an end here already
                continue;
            OutputFile can_be_written;
            TRY(can_be_written.open(table.c_str()));
        }
    return words.plot.empty() ? Status{} : make_folder(words.plot);
}

Status write_tables(const std::string& path, const Report& report)
{
    if (path == kStandardOutput) {
        std::printf("%s%s", plant_csv_names().c_str(), report.plant_lines.c_str());
        return {};
    }
    TRY(write_file(path, plant_csv_names() + report.plant_lines));
    return write_file(beside_table(path), leaf_csv_names() + report.leaf_lines);
}

Status run(const TraitsWords& words)
{
    TRY(check_outputs(words));
    const std::string archive = TRY(archive_folder(words.archive));
    const TraitsWishes wishes = TRY(wishes_of(words));
    std::vector<DeviceFolder> boards = TRY(boards_of_archive(archive));
    if (!words.device.empty())
        std::erase_if(boards, [&](const DeviceFolder& board) { return board.device != words.device; });
    if (boards.empty())
        return failure(Fault::kNoInput, "%s: there is no board%s%s in it", shown(archive).c_str(),
                       words.device.empty() ? "" : " called ", shown(words.device).c_str());
    TRY(try_outputs(words));
    const StopRequest stop;
    StoreOutcome worst(FoundStores{});
    Report report;
    for (const DeviceFolder& board : boards) {
        worst.add(in_store(board.path, report_board(board, words, wishes, report)));
        if (!StopRequest::asked())
            continue;
        return worst.worst().ok() ? failure(Fault::kTryAgain, "stopped: no table is written; what was measured is kept")
                                  : Status{worst.worst()};
    }
    if (!words.csv.empty())
        TRY(write_tables(words.csv, report));
    if (!words.plot.empty())
        TRY(write_plots(words.plot, report.plots));
    if (words.json)
        std::printf("%s\n", json_text({{"archive", archive}, {"boards", report.boards}}, -1).c_str());
    return worst.worst();
}

} // namespace

void add_traits(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("traits", "What grew in an archive: traits and growth of every plant");
    auto words = std::make_shared<TraitsWords>();
    command->add_option("ARCHIVE", words->archive,
                        "the archive's folder, or a board's alone (default: dicot-clouds in your home)");
    command->add_option("--device", words->device, "this board's alone")->type_name("NAME");
    command->add_option("--since", words->since, "from this day or time on, UTC")->type_name("TIME");
    command->add_option("--until", words->until, "to the end of this day or time, UTC")->type_name("TIME");
    command
        ->add_option(
            "--csv", words->csv,
            "a line a plant and snapshot, and a line a leaf in FILE's name with .leaves.csv; no FILE: the first "
            "to standard output")
        ->type_name("FILE")
        ->expected(0, 1)
        ->default_str(kStandardOutput);
    command->add_option("--plot", words->plot, "folder for the curves as SVG, and a page of them")->type_name("DIR");
    command
        ->add_option("--plants", words->places,
                     "plants by name: CSV with name, min_x_mm .. max_z_mm, boxes in the ground frame")
        ->type_name("FILE");
    command->add_option("--timezone", words->timezone, "where the plants stand (default: as the records say)")
        ->type_name("ZONE");
    command->add_option("--cache", words->cache, "folder of what was measured before (default: ~/.cache/dicot)")
        ->type_name("DIR");
    command->add_option("--threads", words->threads, "snapshots at a time (default: 2)")->check(CLI::Range(1, 64));
    command->add_flag("--json", words->json, "report as JSON, with the curves");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
