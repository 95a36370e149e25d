// dicot archive: what was pulled, and what is missing of it.
#include "../commands.h"
#include "../progress.h"
#include "../stop_request.h"
#include "../store/shown.h"
#include "../store/slot_words.h"
#include "../store/store_outcome.h"
#include "archive_folder.h"
#include "archive_words.h"

#include "dicot/medium/disk_medium.h"
#include "dicot/pull_archive/archive_look.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct ArchiveWords
{
    std::string archive;
    bool json = false;
};

struct Told
{
    ArchiveSummary summary;
    std::vector<std::string> flaws;
};

Status look(const DeviceFolder& board, Told& told)
{
    const std::unique_ptr<Medium> medium = TRY(open_disk_medium(board.path));
    told.summary.look = TRY(look_at_archive(
        *medium, [&](const RecordFacts& facts) { told.summary.add(facts); },
        [&](const Status& flaw) { told.flaws.push_back(shown(flaw.message())); }));
    return {};
}

Status status(const ArchiveWords& words)
{
    const std::string archive = TRY(archive_folder(words.archive));
    StoreOutcome worst(FoundStores{});
    nlohmann::json boards = nlohmann::json::array();
    for (const DeviceFolder& board : TRY(boards_of_archive(archive))) {
        Told told;
        Status looked = in_store(board.path, look(board, told));
        if (looked.ok() && !told.flaws.empty())
            looked = failure(Fault::kBadData, "%s: %s cannot be read: dicot archive check names what is damaged",
                             shown(board.path).c_str(), counted(std::ssize(told.flaws), "snapshot").c_str());
        if (words.json)
            boards.push_back(summary_json(board.device, told.summary));
        else
            std::printf("%s", summary_words(board.device, told.summary).c_str());
        worst.add(looked);
    }
    if (words.json)
        std::printf("%s\n", json_text({{"archive", archive}, {"boards", boards}}).c_str());
    return worst.worst();
}

/// What was found until a failure stays in `findings`.
Status check_board(const DeviceFolder& board, bool json, ArchiveCheck& check, nlohmann::json& findings)
{
    const std::unique_ptr<Medium> medium = TRY(open_disk_medium(board.path));
    Progress bar("checking");
    const auto found = [&](const Status& flaw) {
        findings.push_back(flaw.message());
        if (json)
            return;
        bar.wipe();
        std::printf("%s: %s\n", shown(board.path).c_str(), shown(flaw.message()).c_str());
        std::fflush(stdout);
    };
    check = TRY(check_archive(*medium, found, [&](std::int64_t done, std::int64_t all) {
        bar.done(static_cast<int>(done), static_cast<int>(all));
        return !StopRequest::asked();
    }));
    return {};
}

Status check(const ArchiveWords& words)
{
    const std::string archive = TRY(archive_folder(words.archive));
    const StopRequest stop;
    StoreOutcome worst(FoundStores{});
    nlohmann::json boards = nlohmann::json::array();
    for (const DeviceFolder& board : TRY(boards_of_archive(archive))) {
        ArchiveCheck found;
        nlohmann::json findings = nlohmann::json::array();
        Status checked = in_store(board.path, check_board(board, words.json, found, findings));
        if (checked.ok() && found.damaged > 0)
            checked = failure(Fault::kBadData,
                              "%s: %s damaged: dicot pull --verify takes them anew from a source that has them",
                              shown(board.path).c_str(), counted(found.damaged, "snapshot").c_str());
        if (words.json)
            boards.push_back({{"device", board.device},
                              {"path", board.path},
                              {"snapshots", found.snapshots},
                              {"damaged", found.damaged},
                              {"bytes", found.bytes},
                              {"findings", findings},
                              {"exit_code", checked.exit_code()}});
        else
            std::printf("%s: %s and %s read; %s\n", shown(board.path).c_str(),
                        counted(found.snapshots, "snapshot").c_str(),
                        shown_bytes(static_cast<double>(found.bytes)).c_str(),
                        !checked.ok() ? "see below" : "everything is as it was taken");
        worst.add(checked);
        if (StopRequest::asked())
            break;
    }
    if (words.json)
        std::printf("%s\n", json_text({{"archive", archive}, {"boards", boards}}).c_str());
    return worst.worst();
}

void add_words(CLI::App& command, const std::shared_ptr<ArchiveWords>& words)
{
    command.add_option("DEST", words->archive, "the archive's folder (default: dicot-clouds in your home)");
    command.add_flag("--json", words->json, "report as JSON");
}

} // namespace

void add_archive(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("archive", "What was pulled into an archive on this computer");
    command->require_subcommand(1);
    auto words = std::make_shared<ArchiveWords>();
    CLI::App* status_command =
        command->add_subcommand("status", "What is there of each board, what was missed, and what is missing");
    add_words(*status_command, words);
    status_command->callback([words, &chosen] { chosen = [words] { return status(*words); }; });
    CLI::App* check_command =
        command->add_subcommand("check", "Reads and hashes all of it; exit code 65 if something is damaged");
    add_words(*check_command, words);
    check_command->callback([words, &chosen] { chosen = [words] { return check(*words); }; });
}

} // namespace dicot::app
