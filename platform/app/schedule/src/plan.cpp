#include "dicot/schedule/plan.h"

#include <algorithm>

namespace dicot::app {
namespace {

/// A walk that passes over what has been taken.
class Fresh
{
public:
    Fresh(const Schedule& schedule, const TimeZone& zone, const PlanFacts& facts, std::int64_t after_us) noexcept
        : walk_(schedule, zone, after_us), facts_(facts)
    {
    }

    std::optional<Slot> next() noexcept
    {
        std::optional<Slot> slot = walk_.next();
        while (slot && (slot->due_us == facts_.taken_us || (facts_.clock_set && slot->due_us == facts_.last_due_us)))
            slot = walk_.next();
        return slot;
    }

private:
    SlotWalk walk_;
    const PlanFacts& facts_;
};

} // namespace

Plan plan_next(const Schedule& schedule, const TimeZone& zone, const PlanFacts& facts,
               FunctionRef<bool(const Slot&)> missed) noexcept
{
    Plan plan;
    const std::int64_t last_us = facts.clock_set ? facts.last_due_us.value_or(facts.now_us) : facts.now_us;
    if (last_us >= facts.now_us) {
        const bool corrected = last_us - facts.now_us <= kSmallStepBackUs;
        plan.next = Fresh(schedule, zone, facts, corrected ? last_us : facts.now_us).next();
        return plan;
    }

    std::optional<Slot> newest;
    std::int64_t over = 0;
    Fresh all(schedule, zone, facts, last_us);
    for (plan.next = all.next(); plan.next && plan.next->due_us <= facts.now_us; plan.next = all.next()) {
        newest = plan.next;
        ++over;
    }
    if (newest && facts.now_us - newest->due_us <= facts.late_us) {
        plan.next = newest;
        plan.late = true;
        --over;
    }
    plan.missed_older = std::max(std::int64_t{0}, over - kMostMissedRows);
    Fresh again(schedule, zone, facts, last_us);
    for (std::int64_t i = 0; i < over && plan.told_all; ++i) {
        const std::optional<Slot> slot = again.next();
        if (!slot || i < plan.missed_older)
            continue;
        plan.told_all = missed(*slot);
        plan.missed += plan.told_all ? 1 : 0;
    }
    return plan;
}

} // namespace dicot::app
