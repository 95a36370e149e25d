// What a series knows of a slot before it begins.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/power/rest.h"

#include <cstdint>
#include <optional>

namespace dicot::app {

/// A snapshot that somebody asked for has no notes.
struct SlotNotes
{
    std::optional<std::int64_t> due_us; ///< when it was planned
    ShortText<31> why;                  ///< the schedule's word for it
    std::optional<Woken> woken;         ///< how the rest before it ended
    std::int64_t begun_us = 0;          ///< when the slot was to begin, that its pair is taken in time
    std::int64_t clock_shift_us = 0;    ///< Timekeeper::shift_us()
};

} // namespace dicot::app
