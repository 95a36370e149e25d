// Time as a series has it: that of the board, or a time that is told.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/os/clock_trust.h"
#include "dicot/power/rest.h"

#include <cstdint>
#include <optional>

namespace dicot::app {

/// No call takes anything from the heap.
class Timekeeper
{
public:
    virtual ~Timekeeper() = default;

    /// `newest_us`: a time that is known to be over.
    virtual ClockReading now(std::optional<std::int64_t> newest_us) = 0;
    /// No slot was planned before that on a clock that was right, microseconds since 1970, UTC.
    virtual std::int64_t earliest_us() const { return built_us(); }
    /// Added to the system's clock it gives this one, microseconds; 0 unless time is told.
    virtual std::int64_t shift_us() const { return 0; }

    /// How this start came about. Once, first.
    virtual Woken begun() = 0;
    /// When the slot that is due then begins: earlier, as cameras have to warm up.
    virtual std::int64_t begin_us(std::int64_t due_us) const = 0;
    /// Until then, or until something else comes up. `step` is called now and then: whether to go on.
    virtual Woken rest(const RestWish& wish, FunctionRef<bool()> step) = 0;
    /// From the slot's beginning to the pair's being taken: for the next begin_us().
    virtual void pair_was_ready_after(std::int64_t us) = 0;
};

} // namespace dicot::app
