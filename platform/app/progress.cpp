#include "progress.h"

#include "dicot/os/clock.h"

#include <cstdio>
#include <unistd.h>

namespace dicot::app {
namespace {

constexpr std::int64_t kFirstDrawUs = 300'000; // what is done sooner needs no line
constexpr std::int64_t kRedrawUs = 100'000;

} // namespace

Progress::Progress(const char* what) noexcept
    : what_(what), terminal_(isatty(STDERR_FILENO) == 1), start_us_(monotonic_us()), next_us_(start_us_ + kFirstDrawUs)
{
}

void Progress::wipe() noexcept
{
    if (drawn_.exchange(false))
        std::fprintf(stderr, "\r\033[K");
}

void Progress::done(int part, int all) noexcept
{
    if (!terminal_ || part <= 0 || all <= 0)
        return;
    const std::int64_t now = monotonic_us();
    std::int64_t due = next_us_.load(std::memory_order_relaxed);
    if (now < due || !next_us_.compare_exchange_strong(due, now + kRedrawUs))
        return;
    drawn_ = true;
    const double left_s = static_cast<double>(now - start_us_) * (all - part) / part * 1e-6;
    std::fprintf(stderr, "\r%s: %3d %%, %.1f s left\033[K", what_, 100 * part / all, left_s);
}

} // namespace dicot::app
