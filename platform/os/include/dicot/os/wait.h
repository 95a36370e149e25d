// Waiting for a time of day.
#pragma once

#include "dicot/base/function_ref.h"

#include <cstdint>

namespace dicot {

enum class WaitEnd
{
    kTime,         ///< it is time
    kClockChanged, ///< the system's clock was set; what time it is now must be looked at anew
    kAsked,        ///< `step` returned false
};

/// Rests until the system's clock shows `until_us` (since 1970, UTC). `step` is called at the start, then each
/// `step_us`, and after each signal that came. A clock that is set ends it at once; steering (NTP) and sleep of the
/// board do not. No heap, no processor time in between.
WaitEnd wait_until(std::int64_t until_us, std::int64_t step_us, FunctionRef<bool()> step) noexcept;

std::int64_t utc_now_us() noexcept;  ///< what the system's clock shows
std::int64_t boottime_us() noexcept; ///< since the board was started, its sleep included; CLOCK_BOOTTIME

/// The kernel's name of this boot, 36 characters; empty: it is not told. `proc`: for tests.
struct BootId
{
    char text[37] = {};
};
BootId boot_id(const char* proc = "/proc") noexcept;

} // namespace dicot
