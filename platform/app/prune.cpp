// dicot prune: room for what is to come, as the configuration allows.
#include "commands.h"
#include "store/shown.h"
#include "store/slot_record.h"
#include "store/slot_words.h"
#include "store/start_words.h"
#include "store/store_outcome.h"
#include "store/store_words.h"

#include "dicot/os/clock_trust.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct PruneWords
{
    StoreWords store;
    std::optional<double> older_than_days;
    bool dry_run = false;
    bool json = false;
};

constexpr double kMostDays = 100'000;

/// Written so that what is no number is none of these.
bool is_age(double days)
{
    return days > 0 && days <= kMostDays;
}

/// A clock that is wrong must not make everything old.
Result<std::int64_t> day_before(double days, Catalogue& catalogue)
{
    const ClockReading clock = read_clock(TRY(newest_time(catalogue)));
    if (clock.trust == ClockTrust::kNotSet)
        return failure(Fault::kUnavailable,
                       "--older-than asks for a clock that can be trusted, and of this one %s: set it", clock.why);
    return clock.now_us - static_cast<std::int64_t>(days * 86'400e6);
}

struct Pruned
{
    PruneReport report;
    StartReport start;
    std::uint64_t missing_bytes = 0; ///< to the reserve
    nlohmann::json slots = nlohmann::json::array();
};

Result<std::uint64_t> missing_bytes(Medium& medium, const StoreRules& rules, std::uint64_t to_come)
{
    MediumSpace space;
    if (!medium.space(space).ok())
        return failure(Fault::kIoError, "the file system does not tell its free space");
    const std::uint64_t free_bytes = space.free_bytes + to_come;
    return free_bytes < rules.reserve_bytes ? rules.reserve_bytes - free_bytes : 0;
}

/// What went until a failure stays in `pruned`.
Status prune(const PruneWords& words, const DeviceFolder& device, const StoreRules& rules, Pruned& pruned)
{
    const WrittenStore store = TRY(WrittenStore::open(device.path, rules));
    pruned.start = store.store->start_report();
    tell_start(*store.store, device.path);
    PruneWish wish;
    wish.free_bytes = rules.reserve_bytes;
    wish.dry_run = words.dry_run;
    if (words.older_than_days)
        wish.older_than_us = TRY(day_before(*words.older_than_days, store.store->catalogue()));
    pruned.report = TRY(store.store->prune(wish, [&](const SlotRow& row) {
        if (words.json)
            pruned.slots.push_back(slot_json(row));
        else
            std::printf("%-15s  %s\n", shown(device.device).c_str(), slot_line(row).c_str());
    }));
    pruned.missing_bytes = TRY(missing_bytes(*store.medium, rules, words.dry_run ? pruned.report.bytes : 0));
    return {};
}

Status reserve_is_kept(const Pruned& pruned, const StoreRules& rules)
{
    if (pruned.missing_bytes == 0)
        return {};
    return failure(Fault::kTryAgain, "%s are still missing to output.reserve_mib: %s",
                   shown_bytes(static_cast<double>(pruned.missing_bytes)).c_str(),
                   rules.prune == Prune::kAll ? "delete what else is there, or take a larger card"
                                              : "pull snapshots, or allow more with output.prune");
}

nlohmann::json json_of(const DeviceFolder& device, const Pruned& pruned, const Status& outcome)
{
    nlohmann::json told = {{"device", device.device},
                           {"path", device.path},
                           {"start", start_record(pruned.start)},
                           {"removed", pruned.report.removed},
                           {"bytes", pruned.report.bytes},
                           {"missing_bytes", pruned.missing_bytes},
                           {"slots", pruned.slots}};
    if (!outcome.ok())
        told["error"] = outcome.message();
    return told;
}

Status run(const PruneWords& words)
{
    if (words.older_than_days && !is_age(*words.older_than_days))
        return failure(Fault::kUsage, "--older-than is %g: give days, more than 0 and at most %.0f",
                       *words.older_than_days, kMostDays);
    const FoundStores found = TRY(words.store.find());
    const StoreRules rules = rules_of(found.output);
    StoreOutcome outcome(found);
    nlohmann::json stores = nlohmann::json::array();
    for (const DeviceFolder& device : found.devices) {
        Pruned pruned;
        Status done = prune(words, device, rules, pruned);
        if (done.ok() && !words.json)
            std::printf("%s: %s, %s %s (output.prune is \"%s\")\n", shown(device.path).c_str(),
                        counted(pruned.report.removed, "snapshot").c_str(),
                        shown_bytes(static_cast<double>(pruned.report.bytes)).c_str(),
                        words.dry_run ? "would go" : "deleted", found.output.prune.c_str());
        if (done.ok())
            done = reserve_is_kept(pruned, rules);
        done = in_store(device.path, done);
        if (words.json)
            stores.push_back(json_of(device, pruned, done));
        outcome.add(done);
    }
    if (words.json)
        std::printf("%s\n", json_text({{"root", found.root}, {"dry_run", words.dry_run}, {"stores", stores}}).c_str());
    else if (found.devices.empty() && found.unread.empty())
        std::printf("%s: there is no snapshot yet\n", shown(found.root).c_str());
    return outcome.worst();
}

} // namespace

void add_prune(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand(
        "prune", "Deletes the oldest snapshots until output.reserve_mib is free, of those that output.prune allows");
    auto words = std::make_shared<PruneWords>();
    command->add_flag("--dry-run", words->dry_run, "only says what would go");
    command->add_option("--older-than", words->older_than_days, "and all of them that are older than so many days")
        ->type_name("DAYS");
    words->store.add_to(*command);
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
