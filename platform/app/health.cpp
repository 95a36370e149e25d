// dicot health: what is wrong with a rig, and what to do about it, out of its store alone.
#include "commands.h"
#include "health/board_health.h"
#include "store/shown.h"
#include "store/slot_words.h"
#include "store/store_outcome.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct HealthWords
{
    StoreWords store;
    bool json = false;
};

Status run(const HealthWords& words)
{
    const FoundStores found = TRY(words.store.find());
    const StoreRules rules = rules_of(found.output);
    StoreOutcome outcome(found);
    nlohmann::json all = nlohmann::json::array();
    const char* before = "";
    for (const DeviceFolder& device : found.devices) {
        nlohmann::json told = {{"device", device.device}, {"path", device.path}};
        const Status looked = in_store(device.path, [&]() -> Status {
            ReadStore store = TRY(ReadStore::open(device.path));
            const BoardHealth board = TRY(board_health(store, rules, device.path));
            if (words.json)
                told.update(board_json(board));
            else
                std::printf("%s%s", before, board_words(board, device.device, device.path).c_str());
            before = "\n";
            return all_days_told(device.path);
        }());
        if (!looked.ok())
            told["error"] = looked.message();
        all.push_back(told);
        outcome.add(looked);
    }
    if (words.json)
        std::printf("%s\n", json_text({{"root", found.root}, {"stores", all}}).c_str());
    else if (found.devices.empty() && found.unread.empty())
        std::printf("%s: there is no snapshot yet: dicot snap makes one\n", shown(found.root).c_str());
    return outcome.worst();
}

} // namespace

void add_health(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand(
        "health", "How each board is: what is flagged, why, and what to do; what was missed; the trend of two weeks. "
                  "Ends with 0 whatever is flagged: \"state\" in --json tells it to programs");
    auto words = std::make_shared<HealthWords>();
    words->store.add_to(*command);
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
