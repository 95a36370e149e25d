#include "found_slot.h"

#include "shown.h"

#include "dicot/store/look.h"

#include <optional>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

/// "17 and 19", of the slots around one that is not there.
Result<std::string> neighbours(Catalogue& catalogue, std::int64_t sequence)
{
    std::string names;
    const auto note = [&names](const SlotRow& row) {
        names += (names.empty() ? "" : " and ") + std::to_string(row.sequence);
        return false;
    };
    SlotQuery before;
    before.last_sequence = sequence;
    before.last = 1;
    TRY(catalogue.for_each(before, note));
    SlotQuery behind;
    behind.first_sequence = sequence;
    TRY(catalogue.for_each(behind, note));
    return names;
}

} // namespace

Result<FoundSlot> find_slot(const FoundStores& found, std::int64_t sequence, StoreOutcome& outcome)
{
    std::vector<FoundSlot> slots;
    std::string near;
    for (const DeviceFolder& device : found.devices) {
        outcome.add(in_store(device.path, [&]() -> Status {
            const ReadStore store = TRY(ReadStore::open(device.path));
            if (const std::optional<SlotRow> row = TRY(store.catalogue->find(sequence))) {
                slots.push_back({device, *row});
                return {};
            }
            if (const std::string names = TRY(neighbours(*store.catalogue, sequence)); !names.empty())
                near += (near.empty() ? "" : "; ") + shown(device.device) + " has " + names;
            return all_days_told(device.path);
        }()));
    }
    if (slots.size() == 1)
        return slots.front();
    if (slots.size() > 1)
        return failure(Fault::kUsage, "%s: %zu boards have a slot %lld: say which with --device, e.g. %s",
                       shown(found.root).c_str(), slots.size(), static_cast<long long>(sequence),
                       shown(slots.front().device.device).c_str());
    return failure(Fault::kNoInput, "%s: there is no slot %lld: %s", shown(found.root).c_str(),
                   static_cast<long long>(sequence),
                   !near.empty()          ? near.c_str()
                   : outcome.worst().ok() ? "there is none at all"
                                          : "none where it could be looked for");
}

} // namespace dicot::app
