#include "dicot/os/clock_trust.h"

#include "dicot/base/utc_time.h"

#include <sys/timex.h>

#include <ctime>

namespace dicot {
namespace {

/// None: nobody steers the clock.
std::optional<std::int64_t> kernels_bound() noexcept
{
    timex discipline{};
    if (::adjtimex(&discipline) < 0 || (static_cast<unsigned>(discipline.status) & STA_UNSYNC) != 0)
        return std::nullopt;
    return discipline.maxerror;
}

} // namespace

std::int64_t built_us() noexcept
{
    return parse_utc_text(DICOT_BUILT_DAY "T00:00:00Z").value_or(0);
}

ClockReading judge_clock(std::int64_t now_us, std::optional<std::int64_t> most_error_us,
                         std::optional<std::int64_t> newest_us) noexcept
{
    if (most_error_us)
        return {now_us, ClockTrust::kSynchronised, most_error_us, "the kernel says that it is steered (adjtimex)"};
    if (now_us < built_us())
        return {now_us, ClockTrust::kNotSet, {}, "it shows a time before this program was built"};
    if (newest_us && now_us < *newest_us)
        return {now_us, ClockTrust::kNotSet, {}, "it shows a time before that of the newest snapshot"};
    return {now_us, ClockTrust::kSet, {}, "nothing contradicts it, and nobody steers it"};
}

ClockReading read_clock(std::optional<std::int64_t> newest_us) noexcept
{
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    return judge_clock(std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000, kernels_bound(), newest_us);
}

const char* name_of(ClockTrust trust) noexcept
{
    switch (trust) {
    case ClockTrust::kSynchronised:
        return "synchronised";
    case ClockTrust::kSet:
        return "set";
    case ClockTrust::kNotSet:
        break;
    }
    return "not set";
}

} // namespace dicot
