// dicot show: all that is known of one slot.
#include "commands.h"
#include "store/found_slot.h"
#include "store/record_words.h"
#include "store/shown.h"
#include "store/slot_words.h"
#include "store/store_outcome.h"
#include "store/store_words.h"

#include "dicot/store/look.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct ShowWords
{
    StoreWords store;
    std::int64_t sequence = 0;
    bool json = false;
};

const char* way_out(const SlotRow& row)
{
    switch (row.kept) {
    case Kept::kHere:
        break;
    case Kept::kPruned:
        return "its folder was deleted to make room";
    case Kept::kQuarantined:
        return "its folder was damaged, and is in quarantine";
    case Kept::kLost:
        return "its folder was taken away";
    }
    return "";
}

Status show(const FoundSlot& slot, bool as_json)
{
    const ReadStore store = TRY(ReadStore::open(slot.device.path));
    const SlotRow& row = slot.row;
    const std::string folder = slot.device.path + "/" + folder_of(row.sequence, row.began_us).c_str();
    nlohmann::json record;
    nlohmann::json files = nlohmann::json::object();
    Status flaw;
    if (row.kept == Kept::kHere) {
        const Result<std::string> text = read_record_text(*store.medium, row);
        if (text.ok())
            record = nlohmann::json::parse(text.value(), nullptr, false);
        else
            flaw = text.status();
        (void)TRY(check_snapshot(*store.medium, row, [&](const char* name, const Status& outcome) {
            files[name] = outcome.ok() ? "ok" : outcome.message();
            if (flaw.ok())
                flaw = outcome;
        }));
    }
    if (as_json) {
        std::printf("%s\n", json_text({{"device", slot.device.device},
                                       {"folder", row.kept == Kept::kHere ? nlohmann::json(folder) : nlohmann::json()},
                                       {"slot", slot_json(row)},
                                       {"files", files},
                                       {"record", record.is_object() ? record : nlohmann::json()}})
                                .c_str());
    } else {
        std::printf("%s of %s: %s\n", std::to_string(row.sequence).c_str(), shown(slot.device.device).c_str(),
                    state_of(row));
        std::printf("  folder        %s\n", row.kept == Kept::kHere ? shown(folder).c_str() : way_out(row));
        std::fputs(row_words(row).c_str(), stdout);
        for (const auto& [name, outcome] : files.items())
            if (outcome != "ok")
                std::printf("  damaged       %s\n", shown(outcome.get<std::string>()).c_str());
        if (flaw.ok() && !files.empty())
            std::printf("  files         %s, all as they were written\n",
                        counted(static_cast<std::int64_t>(files.size()), "file").c_str());
        std::fputs(record_words(record).c_str(), stdout);
    }
    if (flaw.ok())
        return {};
    return failure(Fault::kBadData, "%s", shown(flaw.message()).c_str());
}

Status run(const ShowWords& words)
{
    const FoundStores found = TRY(words.store.find());
    StoreOutcome outcome(found);
    const Result<FoundSlot> slot = find_slot(found, words.sequence, outcome);
    outcome.add(slot.ok() ? in_store(slot.value().device.path, show(slot.value(), words.json)) : slot.status());
    return outcome.worst();
}

} // namespace

void add_show(CLI::App& program, Command& chosen)
{
    CLI::App* command =
        program.add_subcommand("show", "One slot: its record, its files and whether these are as they were written");
    auto words = std::make_shared<ShowWords>();
    command->add_option("NUMBER", words->sequence, "as dicot list has it")->required()->transform(slot_number());
    words->store.add_to(*command);
    command->add_flag("--json", words->json, "the record itself, and what the catalogue has");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
