// The rule of a zone, as POSIX has it in the variable TZ and RFC 8536 at the end of zone files.
#pragma once

#include "dicot/os/time_zone.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace dicot {

/// A day of each year, and a time on it.
struct RuleDate
{
    enum class Kind
    {
        kWithoutLeapDay, ///< "J60" is always 1 March
        kWithLeapDay,    ///< "59" is 29 February in leap years
        kWeekday,        ///< "M3.5.0": month, week (5: the last), day of the week (0: Sunday)
    };
    Kind kind = Kind::kWithLeapDay;
    int day = 0, week = 0, month = 0;
    int time_s = 7200; ///< wall time; may lie in other days
};

struct ZoneRule
{
    struct Summer
    {
        std::int32_t offset_s;
        RuleDate start, end;
    };
    std::int32_t offset_s = 0; ///< east is positive, against POSIX
    std::optional<Summer> summer;
};

/// "UTC0", "<+0545>-5:45", "CET-1CEST,M3.5.0,M10.5.0/3". Summer time without dates is refused: what they would be is
/// left to each system.
std::optional<ZoneRule> parse_zone_rule(std::string_view text) noexcept;

inline constexpr std::int64_t kNoChangeYet = INT64_MIN;

/// What the rule makes of the years until 2100, after `after_s`, when the newest change of the table was, or
/// kNoChangeYet. False: the table is full.
bool append_rule(const ZoneRule& rule, std::int64_t after_s, ZoneTable& table) noexcept;

} // namespace dicot
