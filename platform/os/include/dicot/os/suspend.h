// Sleep of the whole board.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"

#include <cstdint>

namespace dicot {

struct Slept
{
    std::int64_t asleep_us = 0; ///< CLOCK_BOOTTIME less CLOCK_MONOTONIC
    ShortText<63> woken_by;     ///< the interrupt that did it, e.g. "rtc-pl031", "32"; empty: the kernel does not say
};

/// Writes to `<sys>/power/state` and returns when the board is awake again: "mem" where it is offered, else "freeze".
/// Source: Linux, Documentation/admin-guide/pm/sleep-states.rst. Set the alarm before. No heap. Fault::kUnavailable:
/// the board offers neither, no permission. Fault::kTryAgain: a device, or a wake-up that came at the same time, does
/// not let it sleep.
Result<Slept> suspend_board(const char* sys = "/sys") noexcept;

/// Whether suspend_board() has something to write to, without sleeping. Fault::kUnavailable, with the remedy.
Status can_suspend(const char* sys = "/sys") noexcept;

std::int64_t asleep_us() noexcept; ///< how long the board slept since it was started

} // namespace dicot
