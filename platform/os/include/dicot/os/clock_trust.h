// How far the system's clock can be believed: many boards have no battery, and wake up in 1970.
#pragma once

#include <cstdint>
#include <optional>

namespace dicot {

enum class ClockTrust
{
    kNotSet, ///< it shows a time that is over: before this program was built, or before what is known to have been
    kSet,    ///< it shows a time that may be, and nobody steers it
    kSynchronised, ///< it is steered, by NTP or the like: adjtimex(2) does not say STA_UNSYNC
};

struct ClockReading
{
    std::int64_t now_us = 0; ///< since 1970, UTC
    ClockTrust trust = ClockTrust::kNotSet;
    std::optional<std::int64_t> most_error_us; ///< the kernel's bound; none unless synchronised
    const char* why = "";                      ///< a few words, where the trust comes from
};

/// `newest_us`: a time that is known to be over, e.g. that of the newest snapshot.
ClockReading read_clock(std::optional<std::int64_t> newest_us) noexcept;

/// The judgement alone: `most_error_us` is what adjtimex(2) tells of a clock that is steered, none of one that is not.
ClockReading judge_clock(std::int64_t now_us, std::optional<std::int64_t> most_error_us,
                         std::optional<std::int64_t> newest_us) noexcept;

/// "synchronised", "set", "not set".
const char* name_of(ClockTrust trust) noexcept;

/// The day before which this program cannot run, microseconds since 1970: that of its build, or of SOURCE_DATE_EPOCH.
std::int64_t built_us() noexcept;

} // namespace dicot
