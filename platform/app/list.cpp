// dicot list: every slot, done or missed, and how long the card will last.
#include "commands.h"
#include "store/shown.h"
#include "store/slot_words.h"
#include "store/store_outcome.h"
#include "store/store_summary.h"
#include "store/store_words.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct ListWords
{
    StoreWords store;
    std::string since, until;
    std::optional<std::int64_t> last;
    bool missed = false;
    bool json = false;
};

Result<SlotQuery> query_of(const ListWords& words)
{
    SlotQuery query = TRY(query_between(words.since, words.until));
    query.missed_only = words.missed;
    query.last = words.last;
    return query;
}

void print(const StoreSummary& summary)
{
    const SlotTotals& totals = summary.totals;
    std::printf("%s: %lld done, %lld missed; %lld pulled, %lld pruned, %lld in quarantine, %lld lost; %s here\n",
                counted(totals.slots, "slot").c_str(), static_cast<long long>(totals.done),
                static_cast<long long>(totals.missed), static_cast<long long>(totals.pulled),
                static_cast<long long>(totals.pruned), static_cast<long long>(totals.quarantined),
                static_cast<long long>(totals.lost), shown_bytes(static_cast<double>(totals.bytes_here)).c_str());
    std::printf("%s free, %s of it reserved: ", shown_bytes(static_cast<double>(summary.space.free_bytes)).c_str(),
                shown_bytes(static_cast<double>(summary.reserve_bytes)).c_str());
    std::printf("%s\n", room_words(summary).c_str());
}

/// A table; a store of years is printed as it is read.
Status list_as_text(const DeviceFolder& device, const StoreRules& rules, const SlotQuery& query, bool first)
{
    ReadStore store = TRY(ReadStore::open(device.path));
    const StoreSummary summary = TRY(store_summary(store, rules, device.path));
    std::printf("%s%s\n%-15s  %s\n", first ? "" : "\n", shown(device.path).c_str(), "device", slot_heading().c_str());
    const std::string name = shown(device.device);
    std::int64_t rows = 0;
    TRY(store.catalogue->for_each(query, [&](const SlotRow& row) {
        ++rows;
        std::printf("%-15s  %s\n", name.c_str(), slot_line(row).c_str());
        return std::ferror(stdout) == 0;
    }));
    if (rows < summary.totals.slots)
        std::printf("%s shown; in all ", counted(rows, "slot").c_str());
    print(summary);
    return all_days_told(device.path);
}

/// What stands in a board's object behind its path, one line a slot.
Status list_as_json(const DeviceFolder& device, const StoreRules& rules, const SlotQuery& query)
{
    ReadStore store = TRY(ReadStore::open(device.path));
    const StoreSummary summary = TRY(store_summary(store, rules, device.path));
    std::printf(", \"summary\": %s, \"slots\": [", json_text(summary_json(summary), -1).c_str());
    const char* before_row = "\n";
    const Status listed = store.catalogue->for_each(query, [&](const SlotRow& row) {
        std::printf("%s%s", before_row, json_text(slot_json(row), -1).c_str());
        before_row = ",\n";
        return std::ferror(stdout) == 0;
    });
    std::printf("]");
    return listed.ok() ? all_days_told(device.path) : listed;
}

Status run(const ListWords& words)
{
    const SlotQuery query = TRY(query_of(words));
    const FoundStores found = TRY(words.store.find());
    const StoreRules rules = rules_of(found.output);
    StoreOutcome outcome(found);
    if (words.json)
        std::printf("{\"root\": %s, \"stores\": [", json_text(found.root).c_str());
    for (const DeviceFolder& device : found.devices) {
        const bool first = &device == &found.devices.front();
        if (words.json)
            std::printf("%s{\"device\": %s, \"path\": %s", first ? "\n" : ",\n", json_text(device.device).c_str(),
                        json_text(device.path).c_str());
        const Status listed = in_store(device.path, words.json ? list_as_json(device, rules, query)
                                                               : list_as_text(device, rules, query, first));
        if (words.json && !listed.ok())
            std::printf(", \"error\": %s", json_text(listed.message()).c_str());
        if (words.json)
            std::printf("}");
        outcome.add(listed);
    }
    if (words.json)
        std::printf("]}\n");
    else if (found.devices.empty() && found.unread.empty())
        std::printf("%s: there is no snapshot yet: dicot snap makes one\n", shown(found.root).c_str());
    return outcome.worst();
}

} // namespace

void add_list(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand(
        "list", "The slots of a store: done, missed and why, pulled when; and what room is left");
    auto words = std::make_shared<ListWords>();
    command->add_option("--since", words->since, "from this day or time on, UTC")->type_name("TIME");
    command->add_option("--until", words->until, "to the end of this day or time, UTC")->type_name("TIME");
    command->add_flag("--missed", words->missed, "the missed ones alone");
    command->add_option("--last", words->last, "the newest ones alone, so many of each board")
        ->transform(slot_number());
    words->store.add_to(*command);
    command->add_flag("--json", words->json, "report as JSON, one line a slot");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
