#include "judge_health.h"

#include "health_judges.h"

namespace dicot::app {

const char* name_of(Severity severity) noexcept
{
    switch (severity) {
    case Severity::kNotice:
        return "notice";
    case Severity::kWarning:
        return "warning";
    case Severity::kAlarm:
        break;
    }
    return "alarm";
}

void HealthFlags::add(const HealthFlag& flag) noexcept
{
    if (size_ < kMost)
        flags_[size_++] = flag;
}

HealthFlags judge_health(const HealthHistory& history, const HealthFigures& figures) noexcept
{
    HealthFlags flags;
    judge_pictures(history, figures, flags);
    judge_rig(history, figures, flags);
    judge_board(history, figures, flags);
    return flags;
}

} // namespace dicot::app
