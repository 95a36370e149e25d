// dicot pull: everything new from every board into an archive on this computer.
#include "../commands.h"
#include "../stop_request.h"
#include "../store/shown.h"
#include "../store/slot_words.h"
#include "../store/store_outcome.h"
#include "archive_folder.h"
#include "pull_job.h"
#include "pull_report.h"

#include "dicot/base/utc_time.h"
#include "dicot/os/thread_crew.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace dicot::app {
namespace {

constexpr int kMostAtOnce = 16;

struct PullWords
{
    std::string archive;
    std::string device;
    std::string from;
    std::string since;
    bool verify = false;
    bool all = false;
    bool set_clock = false;
    bool json = false;
};

/// What one job came to.
struct JobOutcome
{
    Status opened;
    std::vector<PullReport> boards;
};

Result<PullWishes> wishes_of(const PullWords& words)
{
    PullWishes wishes;
    wishes.archive = TRY(archive_folder(words.archive));
    wishes.verify = words.verify;
    wishes.all = words.all;
    wishes.set_clock = words.set_clock;
    if (words.since.empty())
        return wishes;
    const std::optional<TimeSpan> since = parse_time(words.since);
    if (!since)
        return failure(Fault::kUsage, "--since is %s: give a day or a time in UTC, as 2026-06-01 or 2026-06-01T12:30",
                       shown(words.since).c_str());
    wishes.since_us = since->first_us;
    return wishes;
}

void pull_job(const PullJob& job, const PullWishes& wishes, BoardNames& names, PullScreen& screen, JobOutcome& outcome)
{
    const Result<std::vector<std::unique_ptr<PullSource>>> sources = job.open();
    outcome.opened = sources.status();
    if (!sources.ok())
        return;
    for (const std::unique_ptr<PullSource>& source : sources.value()) {
        if (StopRequest::asked())
            return;
        outcome.boards.push_back(pull_board(*source, wishes, names, screen));
    }
}

std::vector<JobOutcome> pull_all(const std::vector<PullJob>& jobs, const PullWishes& wishes)
{
    std::vector<JobOutcome> outcomes(jobs.size());
    BoardNames names;
    PullScreen screen;
    const int count = static_cast<int>(jobs.size());
    ThreadCrew crew(std::min(count, kMostAtOnce));
    crew.run(count, [&](int k) {
        const auto at = static_cast<std::size_t>(k);
        pull_job(jobs[at], wishes, names, screen, outcomes[at]);
    });
    return outcomes;
}

Status in_words(const std::string& who, const Status& status)
{
    if (status.ok())
        return status;
    return failure(status.fault(), "%s: %s", shown(who).c_str(), status.message());
}

bool some_board(const std::vector<JobOutcome>& outcomes)
{
    return std::ranges::any_of(outcomes, [](const JobOutcome& outcome) { return !outcome.boards.empty(); });
}

Status print(const PullWords& words, const PullWishes& wishes, const std::vector<PullJob>& jobs,
             const std::vector<JobOutcome>& outcomes)
{
    StoreOutcome worst(FoundStores{});
    std::vector<PullReport> reports;
    nlohmann::json unopened = nlohmann::json::array();
    for (std::size_t k = 0; k < outcomes.size(); ++k) {
        if (!outcomes[k].opened.ok())
            unopened.push_back({{"from", jobs[k].where}, {"error", outcomes[k].opened.message()}});
        const Status opened = in_words(jobs[k].where, outcomes[k].opened);
        if (opened.ok() || jobs[k].must_open || !some_board(outcomes))
            worst.add(opened);
        else
            std::fprintf(stderr, "dicot: left alone: %s\n", opened.message());
        for (const PullReport& report : outcomes[k].boards) {
            worst.add(in_words(report.device, report.outcome));
            reports.push_back(report);
        }
    }
    if (reports.empty() && unopened.empty() && !StopRequest::asked())
        worst.add(
            failure(Fault::kUnavailable,
                    "nothing to pull: no device has a board's folder; is it the board's data cable, and usb.export "
                    "on?"));
    if (StopRequest::asked() && worst.worst().ok())
        worst.add(failure(Fault::kTryAgain, "stopped; the next pull goes on there"));
    if (words.json) {
        nlohmann::json boards = nlohmann::json::array();
        for (const PullReport& report : reports)
            boards.push_back(pull_json(report));
        std::printf("%s\n",
                    json_text({{"archive", wishes.archive}, {"boards", boards}, {"unopened", unopened}}).c_str());
    } else if (!reports.empty())
        std::printf("%sthe archive: %s\n", pull_table(reports).c_str(), shown(wishes.archive).c_str());
    return worst.worst();
}

Status run(const PullWords& words)
{
    const PullWishes wishes = TRY(wishes_of(words));
    const std::vector<PullJob> jobs =
        TRY(words.from.empty() ? jobs_of_devices(words.device) : jobs_of_folder(words.from, words.device));
    const StopRequest stop;
    return print(words, wishes, jobs, pull_all(jobs, wishes));
}

} // namespace

void add_pull(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand(
        "pull", "Everything new from every board on a cable into an archive on this computer, verified");
    auto words = std::make_shared<PullWords>();
    command->add_option("DEST", words->archive, "the archive's folder (default: dicot-clouds in your home)");
    command
        ->add_option("--device", words->device,
                     "the device with this serial number alone; with --from, the board of this name")
        ->type_name("SERIAL");
    command
        ->add_option("--from", words->from, "instead of devices: a card, a copied folder, another archive; only read")
        ->type_name("DIR");
    command->add_option("--since", words->since, "what began on this day or later, UTC, by the board's clock")
        ->type_name("DATE");
    command->add_flag("--all", words->all, "also what another computer has pulled already");
    command->add_flag("--verify", words->verify, "hash what is in the archive before it is believed");
    command->add_flag("--set-clock", words->set_clock, "offer this computer's time to boards whose clock is not set");
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
