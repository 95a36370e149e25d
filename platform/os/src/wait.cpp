#include "dicot/os/wait.h"

#include "dicot/os/small_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include <poll.h>
#include <sys/timerfd.h>
#include <unistd.h>

namespace dicot {
namespace {

/// Steering moves the clock by 10 ms in 20 s at most (500 ppm); NTP's daemons step from 128 ms on, when they start.
constexpr std::int64_t kStepOfClockUs = 500'000;
constexpr std::int64_t kMostStepUs = 86'400'000'000;

std::int64_t microseconds(clockid_t clock) noexcept
{
    timespec now{};
    clock_gettime(clock, &now);
    return std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
}

/// How far the clock of the day is ahead of the one that is never set.
std::int64_t offset_us() noexcept
{
    return utc_now_us() - boottime_us();
}

/// Ready to be read when it is time, or when the clock is set. Without one the wait ends by its steps alone.
class DayTimer
{
public:
    DayTimer() noexcept : descriptor_(::timerfd_create(CLOCK_REALTIME, TFD_CLOEXEC | TFD_NONBLOCK)) {}
    DayTimer(const DayTimer&) = delete;
    DayTimer& operator=(const DayTimer&) = delete;
    ~DayTimer()
    {
        if (descriptor_ >= 0)
            ::close(descriptor_);
    }

    int descriptor() const noexcept { return descriptor_; }
    void arm(std::int64_t until_us) noexcept
    {
        itimerspec when{};
        when.it_value.tv_sec = static_cast<time_t>(until_us / 1'000'000);
        when.it_value.tv_nsec = static_cast<long>(until_us % 1'000'000) * 1000;
        (void)::timerfd_settime(descriptor_, TFD_TIMER_ABSTIME | TFD_TIMER_CANCEL_ON_SET, &when, nullptr);
    }
    void clear() noexcept
    {
        std::uint64_t expirations = 0;
        (void)!::read(descriptor_, &expirations,
                      sizeof expirations); // ECANCELED of a clock that was set: see offset_us()
    }

private:
    int descriptor_;
};

} // namespace

std::int64_t utc_now_us() noexcept
{
    return microseconds(CLOCK_REALTIME);
}

std::int64_t boottime_us() noexcept
{
    return microseconds(CLOCK_BOOTTIME);
}

WaitEnd wait_until(std::int64_t until_us, std::int64_t step_us, FunctionRef<bool()> step) noexcept
{
    step_us = std::clamp(step_us, std::int64_t{1000}, kMostStepUs);
    DayTimer timer;
    std::int64_t offset = offset_us();
    std::int64_t next_step_us = boottime_us();
    for (bool signalled = false;;) {
        if (signalled || boottime_us() >= next_step_us) {
            if (!step())
                return WaitEnd::kAsked;
            next_step_us = boottime_us() + step_us;
        }
        const std::int64_t now = utc_now_us();
        const std::int64_t offset_now = offset_us();
        if (std::abs(offset_now - offset) > kStepOfClockUs)
            return WaitEnd::kClockChanged;
        offset = offset_now;
        if (now >= until_us)
            return WaitEnd::kTime;
        timer.arm(until_us);
        const std::int64_t pause_us = std::min(until_us - now, next_step_us - boottime_us());
        pollfd awaited{timer.descriptor(), POLLIN, 0};
        const int ready = ::poll(&awaited, 1, static_cast<int>(std::max<std::int64_t>(0, pause_us) / 1000 + 1));
        signalled = ready < 0 && errno == EINTR;
        if (ready > 0)
            timer.clear();
    }
}

BootId boot_id(const char* proc) noexcept
{
    BootId id;
    const auto line = read_line(JoinedPath{"%s/sys/kernel/random/boot_id", proc}.c_str());
    if (line && line->view().size() == sizeof id.text - 1)
        std::memcpy(id.text, line->c_str(), sizeof id.text);
    return id;
}

} // namespace dicot
