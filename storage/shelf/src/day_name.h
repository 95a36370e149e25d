// Days as folders are called, and as numbers.
#pragma once

#include "dicot/base/utc_time.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace dicot {

inline constexpr std::int64_t kDayUs = 86'400'000'000;

/// Since 1970, of "2026-06-01"; none: it is no day's name.
std::optional<std::int64_t> day_number(std::string_view name);

inline UtcText day_name(std::int64_t day)
{
    return utc_day(day * kDayUs);
}

} // namespace dicot
