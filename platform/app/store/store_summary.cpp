#include "store_summary.h"

#include "shown.h"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace dicot::app {

Result<StoreSummary> store_summary(ReadStore& store, const StoreRules& rules, const std::string& path)
{
    StoreSummary summary;
    summary.totals = TRY(store.catalogue->totals());
    summary.pace = TRY(store.catalogue->pace());
    summary.reserve_bytes = rules.reserve_bytes;
    if (!store.medium->space(summary.space).ok())
        return failure(Fault::kIoError, "%s: the file system does not tell its free space", shown(path).c_str());
    return summary;
}

nlohmann::json summary_json(const StoreSummary& summary)
{
    const SlotTotals& totals = summary.totals;
    const std::optional<double> days = summary.days_left();
    return {{"slots", totals.slots},
            {"done", totals.done},
            {"missed", totals.missed},
            {"pulled", totals.pulled},
            {"pruned", totals.pruned},
            {"quarantined", totals.quarantined},
            {"lost", totals.lost},
            {"bytes_here", totals.bytes_here},
            {"bytes_per_day",
             summary.pace.bytes_per_day > 0 ? nlohmann::json(summary.pace.bytes_per_day) : nlohmann::json()},
            {"bytes_per_snapshot", summary.pace.bytes_per_snapshot},
            {"largest_snapshot_bytes", summary.pace.most_bytes},
            {"free_bytes", summary.space.free_bytes},
            {"total_bytes", summary.space.total_bytes},
            {"reserve_bytes", summary.reserve_bytes},
            {"days_left", days ? nlohmann::json(*days) : nlohmann::json()}};
}

std::string room_words(const StoreSummary& summary)
{
    constexpr double kManyYears = 3650;
    const std::optional<double> days = summary.days_left();
    if (!days)
        return "how long that lasts is not known yet";
    char text[64] = "room for more than ten years";
    if (*days <= kManyYears)
        std::snprintf(text, sizeof text, "room for %.1f days", *days);
    return text + (" at " + shown_bytes(summary.pace.bytes_per_day)) + " a day";
}

} // namespace dicot::app
