// Suspend and power off: what they are made of, and what becomes of a pause when they fail.
#include "dicot/power/rest.h"

#include "dicot/os/output_file.h"

#include <algorithm>
#include <cstdlib>

#include <unistd.h>

namespace dicot::app {
namespace {

constexpr std::int64_t kSecondUs = 1'000'000;
constexpr int kMostSuspends = 64;                     ///< of one pause: a board that is woken again and again
constexpr int kMostFailures = 3;                      ///< refused, or woken at once
constexpr std::int64_t kShortSleepUs = 2 * kSecondUs; ///< is as good as none
constexpr std::int64_t kRetryUs = 10 * kSecondUs;
constexpr std::int64_t kClockStepUs = 2 * kSecondUs; ///< the board's clock is read in whole seconds
constexpr std::int64_t kAnswerEndsUs = 30 * kSecondUs;

} // namespace

Rest::Next Rest::suspend(std::int64_t begin_us, FunctionRef<bool()> step, Woken& woken) noexcept
{
    int failures = 0;
    for (int round = 0; round < kMostSuspends && failures < kMostFailures; ++round) {
        if (!step()) {
            woken.reason = WakeReason::kAsked;
            return Next::kOver;
        }
        const std::int64_t now_us = board_.now_us();
        const std::int64_t left_us = begin_us - lead_.of(LeadPart::kResume) - now_us;
        if (left_us < rules_.least_rest_us)
            return Next::kIdle;
        const std::int64_t after_s = left_us / kSecondUs;
        if (const Status alarm = board_.wake_after(after_s); !alarm.ok()) {
            tell(alarm, woken);
            return Next::kIdle;
        }
        const std::int64_t boottime_us = board_.boottime_us();
        const Result<Slept> slept = board_.suspend();
        (void)board_.no_alarm(); // one that rang is over; one that did not would wake the next sleep
        const std::int64_t elapsed_us = board_.boottime_us() - boottime_us;
        if (!slept.ok()) {
            tell(slept.status(), woken);
            if (slept.status().fault() != Fault::kTryAgain)
                return Next::kIdle;
            ++failures;
            const WaitEnd end = board_.wait_until(board_.now_us() + kRetryUs, rules_.step_us, step);
            if (end != WaitEnd::kTime) {
                woken.reason = end == WaitEnd::kAsked ? WakeReason::kAsked : WakeReason::kClockChanged;
                return Next::kOver;
            }
            continue;
        }
        woken.way = Between::kSuspend;
        woken.asleep_us += slept.value().asleep_us;
        woken.woken_by = slept.value().woken_by;
        if (std::abs(board_.now_us() - now_us - elapsed_us) > kClockStepUs) {
            woken.reason = WakeReason::kClockChanged;
            return Next::kOver;
        }
        const std::int64_t late_us = elapsed_us - after_s * kSecondUs;
        if (late_us > -kClockStepUs) {
            woken.reason = WakeReason::kAlarm;
            tell(lead_.note(LeadPart::kResume, std::max<std::int64_t>(0, late_us)), woken);
            return Next::kIdle;
        }
        woken.reason = WakeReason::kOther;
        if (elapsed_us < kShortSleepUs && ++failures == kMostFailures)
            tell(failure(Fault::kTryAgain, "the board is woken as soon as it sleeps (by %s); this pause is idled",
                         woken.woken_by.empty() ? "something that the kernel does not name" : woken.woken_by.c_str()),
                 woken);
    }
    return Next::kIdle;
}

Rest::Next Rest::power_off(const RestWish& wish, FunctionRef<bool()> step, Woken& woken) noexcept
{
    const std::int64_t alarm_us = begin_us(wish.due_us) - lead_.of(LeadPart::kBoot);
    const std::int64_t now_us = board_.now_us();
    if (const Status alarm = board_.wake_after((alarm_us - now_us) / kSecondUs); !alarm.ok()) {
        tell(alarm, woken);
        return Next::kIdle;
    }
    tell(write_mark(wish.slot, wish.due_us, alarm_us), woken); // without it only the reason of the next start is lost
    OutputFile request;
    Status asked = request.open(rules_.request.c_str());
    if (asked.ok())
        asked = request.write("power off\n", 10);
    if (asked.ok())
        asked = request.commit();
    tell(asked, woken);
    if (asked.ok() &&
        await_power_off(std::min(rules_.unanswered_us, alarm_us - now_us - kAnswerEndsUs), step, woken) == Next::kOver)
        return Next::kOver;
    (void)::unlink(rules_.request.c_str());
    (void)board_.no_alarm();
    (void)write_mark(0, 0, 0);
    return Next::kIdle;
}

Rest::Next Rest::await_power_off(std::int64_t most_us, FunctionRef<bool()> step, Woken& woken) noexcept
{
    const std::int64_t end_us = board_.boottime_us() + most_us;
    while (board_.boottime_us() < end_us) {
        // A clock that is set meanwhile changes nothing: the alarm is one of the board's own clock.
        const std::int64_t left_us = end_us - board_.boottime_us();
        if (board_.wait_until(board_.now_us() + left_us, rules_.step_us, step) == WaitEnd::kAsked) {
            woken.way = Between::kOff;
            woken.reason = WakeReason::kAsked;
            return Next::kOver;
        }
    }
    tell(failure(Fault::kUnavailable,
                 "%s: nobody answered the request to power off; enable dicot-power-off.path, or set power.between to "
                 "\"idle\"",
                 rules_.request.c_str()),
         woken);
    return Next::kIdle;
}

} // namespace dicot::app
