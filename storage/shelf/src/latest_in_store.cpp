#include "day_name.h"

#include "dicot/shelf/snapshot_shelf.h"

#include <algorithm>
#include <cstring>

namespace dicot {

Result<std::optional<std::int64_t>> latest_in_store(Medium& medium, std::int64_t end_us)
{
    std::optional<std::int64_t> latest;
    const auto look_into = [&](std::string_view day) {
        const UtcText path = day;
        return medium.list(path.c_str(), [&](const MediumEntry& entry) {
            const auto name = entry.kind == EntryKind::kFolder ? parse_snapshot_name(entry.name) : std::nullopt;
            if (name && utc_day(name->began_us) == path && name->began_us < end_us)
                latest = std::max(latest.value_or(name->began_us), name->began_us);
            return true;
        });
    };
    Errno inside;
    const Errno listed = medium.list("", [&](const MediumEntry& entry) {
        if (entry.kind == EntryKind::kFolder && is_day_name(entry.name))
            inside = look_into(entry.name);
        return inside.ok();
    });
    if (const Errno outcome = listed.ok() ? inside : listed; !outcome.ok())
        return failure(Fault::kIoError, "the folder of the snapshots cannot be listed (%s)",
                       strerrordesc_np(outcome.number()));
    return latest;
}

} // namespace dicot
