// The words that a schedule is written in.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace dicot::app {

/// When in a day: at a time of the clock, or so long after the sun rises or sets.
struct Moment
{
    enum class After
    {
        kMidnight, ///< wall time
        kSunrise,
        kSunset,
    };
    After after = After::kMidnight;
    int seconds = 0; ///< whole minutes; kMidnight: 0 .. 86340, else from -12 h to 12 h

    friend bool operator==(const Moment&, const Moment&) = default;
};

/// "06:30", "sunrise", "sunset-1h30m".
std::optional<Moment> parse_moment(std::string_view text) noexcept;

/// "30m", "2h", "1h30m", in seconds; up to 24 h.
std::optional<int> parse_duration_s(std::string_view text) noexcept;

/// "00:00" .. "24:00", in seconds.
std::optional<int> parse_clock_s(std::string_view text) noexcept;

/// Whether it may stand for an interval: empty, or a duration of a minute or more.
bool is_interval(std::string_view text) noexcept;

/// Whether it may name a zone: empty, or letters, digits and what else names and rules of TZ are made of, 63 at most.
bool is_zone_text(std::string_view text) noexcept;

} // namespace dicot::app
