#include "dicot/os/clock.h"

#include <ctime>

namespace dicot {
namespace {

std::int64_t microseconds(clockid_t clock) noexcept
{
    timespec now{};
    clock_gettime(clock, &now);
    return std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
}

} // namespace

std::int64_t monotonic_us() noexcept
{
    return microseconds(CLOCK_MONOTONIC);
}

std::int64_t process_cpu_us() noexcept
{
    return microseconds(CLOCK_PROCESS_CPUTIME_ID);
}

} // namespace dicot
