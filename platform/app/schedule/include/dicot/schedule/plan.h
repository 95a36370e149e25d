// Which slot is next, and which ones are over without a snapshot.
#pragma once

#include "dicot/schedule/schedule.h"

#include "dicot/base/function_ref.h"

#include <cstdint>
#include <optional>

namespace dicot::app {

inline constexpr std::int64_t kMostMissedRows = 2000;
/// A clock that is set back by so much or less has been corrected: what it has passed is not done again.
inline constexpr std::int64_t kSmallStepBackUs = 15LL * 60 * 1'000'000;

/// What is known when a slot is looked for.
struct PlanFacts
{
    /// Of the newest slot that has a row, done or missed, and was planned on a clock that was believed. None: the
    /// first start ever.
    std::optional<std::int64_t> last_due_us;
    std::int64_t now_us = 0;
    bool clock_set = false;   ///< ClockTrust other than kNotSet
    std::int64_t late_us = 0; ///< Schedule::late_us
    /// Of the slot that this run took last, whatever the clock was worth; it is not taken again.
    std::optional<std::int64_t> taken_us = {};
};

struct Plan
{
    std::optional<Slot> next;      ///< none: as SlotWalk::next()
    bool late = false;             ///< it is due since up to late_us: to be taken now
    std::int64_t missed = 0;       ///< given to the visitor
    std::int64_t missed_older = 0; ///< missed before those, too many for rows
    bool told_all = true;          ///< false: the visitor stopped it
};

/// Pure; no heap.
///
/// - Clock not set: the next slot by what it shows, so that the cadence goes on; nothing is missed, for `last_due_us`
/// is
///   of another time. The same on the first start.
/// - Clock set, now after `last_due_us`: what was due between them is missed, in ascending order, kMostMissedRows of
/// the
///   newest ones; but the newest that is due since no longer than late_us is the next one.
/// - Clock set, now before `last_due_us`: a small step back (kSmallStepBackUs) does nothing again. After a larger one
/// the
///   plan begins now, for a clock that was a year ahead must not silence the series for a year; but the slot at
///   `last_due_us` is not the next one.
///
/// `missed` may refuse to go on; the plan is the same then.
Plan plan_next(const Schedule& schedule, const TimeZone& zone, const PlanFacts& facts,
               FunctionRef<bool(const Slot&)> missed) noexcept;

} // namespace dicot::app
