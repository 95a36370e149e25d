// What is told of a store beside its rows.
#pragma once

#include "store_words.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace dicot::app {

struct StoreSummary
{
    SlotTotals totals;
    SlotPace pace;
    MediumSpace space;
    std::uint64_t reserve_bytes = 0;

    double room_bytes() const
    {
        return space.free_bytes > reserve_bytes ? static_cast<double>(space.free_bytes - reserve_bytes) : 0;
    }
    /// None: it is not known how fast the card fills.
    std::optional<double> days_left() const
    {
        return pace.bytes_per_day > 0 ? std::optional{room_bytes() / pace.bytes_per_day} : std::nullopt;
    }
};

/// Errors: the catalogue's; Fault::kIoError: the file system does not tell its free space.
Result<StoreSummary> store_summary(ReadStore& store, const StoreRules& rules, const std::string& path);

nlohmann::json summary_json(const StoreSummary& summary);

/// "room for 12.3 days at 1.2 MiB a day": without its end.
std::string room_words(const StoreSummary& summary);

} // namespace dicot::app
