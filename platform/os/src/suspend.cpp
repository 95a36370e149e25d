#include "dicot/os/suspend.h"

#include "dicot/os/shown_path.h"
#include "dicot/os/small_file.h"

#include <cerrno>
#include <cstring>
#include <ctime>
#include <string_view>

#include <unistd.h>

namespace dicot {
namespace {

std::int64_t microseconds(clockid_t clock) noexcept
{
    timespec now{};
    clock_gettime(clock, &now);
    return std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
}

/// Which sleep is offered; null: none.
const char* deepest(const char* sys) noexcept
{
    const auto offered = read_line(JoinedPath{"%s/power/state", sys}.c_str());
    for (const char* state : {"mem", "freeze"}) {
        std::string_view rest = offered ? offered->view() : std::string_view{};
        while (!rest.empty()) {
            const std::size_t blank = rest.find(' ');
            if (rest.substr(0, blank) == state)
                return state;
            rest = blank == std::string_view::npos ? std::string_view{} : rest.substr(blank + 1);
        }
    }
    return nullptr;
}

Status no_sleep(const char* sys) noexcept
{
    return failure(Fault::kUnavailable,
                   "%s/power/state: the board offers no sleep; set power.between to \"idle\" or \"off\"",
                   shown_path(sys));
}

Status refused(const char* sys, int error) noexcept
{
    const char* shown = shown_path(sys);
    if (error == EACCES || error == EPERM || error == EROFS)
        return failure(Fault::kUnavailable,
                       "%s/power/state: no permission to suspend the board; give the file to the group dicot "
                       "(tmpfiles.d), or set power.between to \"idle\"",
                       shown);
    const auto device = read_line(JoinedPath{"%s/power/suspend_stats/last_failed_dev", sys}.c_str());
    const bool named = device && !device->empty();
    return failure(Fault::kTryAgain, "%s/power/state: the board does not go to sleep (%s%s%.60s)", shown,
                   strerrordesc_np(error), named ? "; the last device that refused is " : "",
                   named ? device->c_str() : "");
}

ShortText<63> waker(const char* sys) noexcept
{
    const auto number = read_line(JoinedPath{"%s/power/pm_wakeup_irq", sys}.c_str());
    if (!number || number->empty())
        return {};
    const auto name = read_line(JoinedPath{"%s/kernel/irq/%s/actions", sys, number->c_str()}.c_str());
    return name && !name->empty() ? name->view() : number->view();
}

} // namespace

std::int64_t asleep_us() noexcept
{
    return microseconds(CLOCK_BOOTTIME) - microseconds(CLOCK_MONOTONIC);
}

Status can_suspend(const char* sys) noexcept
{
    if (deepest(sys) == nullptr)
        return no_sleep(sys);
    return ::access(JoinedPath{"%s/power/state", sys}.c_str(), W_OK) == 0 ? Status{} : refused(sys, errno);
}

Result<Slept> suspend_board(const char* sys) noexcept
{
    const char* const state = deepest(sys);
    if (state == nullptr)
        return no_sleep(sys);
    const std::int64_t before_us = asleep_us();
    if (const int error = write_line(JoinedPath{"%s/power/state", sys}.c_str(), state); error != 0)
        return refused(sys, error);
    return Slept{asleep_us() - before_us, waker(sys)};
}

} // namespace dicot
