// dicot prune: room for what is to come, as the configuration allows.
#include "commands.h"
#include "store/shown.h"
#include "store/slot_words.h"
#include "store/store_words.h"

#include "dicot/os/clock_trust.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct Words
{
    StoreWords store;
    std::optional<double> older_than_days;
    bool dry_run = false;
    bool json = false;
};

constexpr double kMostDays = 36'500;

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
    nlohmann::json slots = nlohmann::json::array();
};

Result<Pruned> prune(const Words& words, const DeviceFolder& device, const StoreRules& rules)
{
    const WrittenStore store = TRY(WrittenStore::open(device.path, rules));
    PruneWish wish;
    wish.free_bytes = rules.reserve_bytes;
    wish.dry_run = words.dry_run;
    if (words.older_than_days)
        wish.older_than_us = TRY(day_before(*words.older_than_days, store.store->catalogue()));
    Pruned pruned;
    pruned.report = TRY(store.store->prune(wish, [&](const SlotRow& row) {
        pruned.slots.push_back(slot_json(row));
        if (!words.json)
            std::printf("%-15s  %s\n", shown(device.device).c_str(), slot_line(row).c_str());
    }));
    return pruned;
}

Status run(const Words& words)
{
    const FoundStores found = TRY(words.store.find());
    const StoreRules rules = rules_of(found.output);
    nlohmann::json stores = nlohmann::json::array();
    for (const DeviceFolder& device : found.devices) {
        const Pruned pruned = TRY(prune(words, device, rules));
        stores.push_back({{"device", device.device},
                          {"path", device.path},
                          {"removed", pruned.report.removed},
                          {"bytes", pruned.report.bytes},
                          {"slots", pruned.slots}});
        if (!words.json)
            std::printf("%s: %s, %s %s (output.prune is \"%s\")\n", shown(device.path).c_str(),
                        counted(pruned.report.removed, "snapshot").c_str(),
                        shown_bytes(static_cast<double>(pruned.report.bytes)).c_str(),
                        words.dry_run ? "would go" : "deleted", found.output.prune.c_str());
    }
    if (words.json)
        std::printf("%s\n", json_text({{"root", found.root}, {"dry_run", words.dry_run}, {"stores", stores}}).c_str());
    else if (found.devices.empty())
        std::printf("%s: there is no snapshot yet\n", shown(found.root).c_str());
    return {};
}

} // namespace

void add_prune(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand(
        "prune", "Deletes the oldest snapshots until output.reserve_mib is free, of those that output.prune allows");
    auto words = std::make_shared<Words>();
    command->add_flag("--dry-run", words->dry_run, "only says what would go");
    command->add_option("--older-than", words->older_than_days, "and all of them that are older than so many days")
        ->type_name("DAYS")
        ->check(CLI::Range(0.0, kMostDays));
    words->store.add_to(*command);
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
