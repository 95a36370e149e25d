#include "told_time.h"

#include <algorithm>
#include <chrono>

namespace dicot::app {

ClockReading ToldTime::now(std::optional<std::int64_t>)
{
    return {now_us_, ClockTrust::kSet, {}, "a rehearsal: time is told"};
}

std::int64_t ToldTime::shift_us() const
{
    using namespace std::chrono;
    return now_us_ - duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

Woken ToldTime::rest(const RestWish& wish, FunctionRef<bool()> step)
{
    Woken woken;
    if (!step()) {
        woken.reason = WakeReason::kAsked;
        return woken;
    }
    now_us_ = std::max(now_us_, begin_us(wish.due_us));
    return woken;
}

} // namespace dicot::app
