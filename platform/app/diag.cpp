// dicot diag: one archive for whoever has to find out from afar what is wrong with a board.
#include "commands.h"
#include "diag/diag_members.h"
#include "diag/told_by.h"
#include "store/shown.h"

#include "dicot/base/utc_time.h"
#include "dicot/os/clock_trust.h"
#include "dicot/os/cpu.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

struct DiagWords
{
    StoreWords store;
    std::string output;
    std::optional<std::int64_t> records;
};

constexpr std::int64_t kUsualRecords = 20;

std::string about()
{
    const CpuFeatures cpu = cpu_features();
    return std::string("dicot " DICOT_VERSION "\nbuilt ") + utc_text(built_us()).c_str() + "\ncompiler " + __VERSION__ +
           "\npointers of " + std::to_string(8 * sizeof(void*)) + " bits\navx2 " + (cpu.avx2 ? "yes" : "no") +
           "\nneon " + (cpu.neon ? "yes" : "no") + "\n";
}

/// What the command tells of this configuration and store; also where it fails half-way, as far as it came.
Status add_told(DiagMembers& members, const std::string& name, std::vector<std::string> words)
{
    const Told told = told_by(std::move(words));
    if (!told.text.empty())
        TRY(members.put(name, told.text));
    const std::string why = told.remarks + (told.status.ok() ? "" : told.status.message());
    if (told.text.empty())
        return members.missing(name, why.empty() ? "it told nothing" : why);
    return why.empty() ? Status{} : members.put(name + ".remarks.txt", why + "\n");
}

Status add_commands(DiagMembers& members, const DiagWords& words)
{
    std::vector<std::string> config;
    if (!words.store.config.file.empty())
        config = {"--config", words.store.config.file};
    std::vector<std::string> store = config;
    if (!words.store.root.empty())
        store.insert(store.end(), {"--store", words.store.root});
    if (!words.store.device.empty())
        store.insert(store.end(), {"--device", words.store.device});
    const auto with = [](std::vector<std::string> command, const std::vector<std::string>& more) {
        command.insert(command.end(), more.begin(), more.end());
        return command;
    };
    TRY(add_told(members, "config.json", with({"config", "--json"}, config)));
    TRY(add_told(members, "memory.json", with({"memory", "--json"}, config)));
    TRY(add_told(members, "schedule.json", with({"schedule", "--json"}, config)));
    TRY(add_told(members, "cameras.json", {"probe", "--json"}));
    TRY(add_told(members, "health.json", with({"health", "--json"}, store)));
    return add_told(members, "slots.json", with({"list", "--json", "--last", "500"}, store));
}

/// Files of one folder, not of those in it.
Status add_folder(DiagMembers& members, const std::string& name, const std::string& path)
{
    constexpr std::size_t kMostFiles = 64;
    std::vector<std::string> files;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(path, error);
         !error && entry != std::filesystem::directory_iterator{}; entry.increment(error))
        if (entry->is_regular_file(error))
            files.push_back(entry->path().filename().string());
    if (error)
        return members.missing(name, path + ": " + error.message());
    std::ranges::sort(files);
    files.resize(std::min(files.size(), kMostFiles));
    for (const std::string& file : files)
        if (name.size() + file.size() < TarGz::kMostName / 2)
            TRY(members.put_file(name + "/" + file, path + "/" + file));
    return {};
}

Status add_files(DiagMembers& members, const DiagWords& words)
{
    const Result<LoadedConfig> loaded = words.store.config.load();
    const std::string file = !words.store.config.file.empty() ? words.store.config.file : kDefaultConfigFile;
    TRY(members.put_file("config.toml", file));
    if (!loaded.ok()) // what is wrong with it stands beside config.json
        return {};
    const Config& config = loaded.value().config;
    TRY(members.put_file("rig.yaml", config.rig.file));
    return add_folder(members, "state", config.run.state);
}

Status add_boards(DiagMembers& members, const DiagWords& words)
{
    const Result<FoundStores> found = words.store.find();
    if (!found.ok())
        return members.missing("boards", found.status().message());
    for (const UnreadFolder& folder : found.value().unread)
        TRY(members.missing("boards/unread", folder.why.message()));
    for (const DeviceFolder& device : found.value().devices)
        TRY(add_board(members, device, words.records.value_or(kUsualRecords)));
    return {};
}

Status run(const DiagWords& words)
{
    const ClockReading clock = read_clock({});
    TarGz archive;
    TRY(archive.open(words.output.c_str(), clock.now_us / 1'000'000));
    DiagMembers members(archive, "dicot-diag");
    TRY(members.put("about.txt", about()));
    TRY(add_commands(members, words));
    TRY(add_files(members, words));
    TRY(add_boards(members, words));
    TRY(add_system(members));
    TRY(archive.commit());
    std::printf("%s: %s, %d not to be had (*.missing.txt says why); tar tzf lists them\n", shown(words.output).c_str(),
                counted(members.made(), "member").c_str(), members.not_made());
    return {};
}

} // namespace

void add_diag(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand(
        "diag", "One archive for the engineer: configuration, rig, cameras, memory, schedule, slots, newest records, "
                "health, system. No pictures. The cameras are asked what they can do: while dicot run uses them, they "
                "say that they are busy");
    auto words = std::make_shared<DiagWords>();
    command->add_option("-o,--output", words->output, "the archive, .tar.gz")->required()->type_name("FILE");
    command->add_option("--records", words->records, "the newest records, so many of each board (default: 20)")
        ->transform(slot_number());
    words->store.add_to(*command);
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
