#include "dicot/power/linux_board.h"

#include "dicot/os/small_file.h"
#include "dicot/os/stage_watch.h"

namespace dicot::app {

std::int64_t LinuxBoard::now_us() noexcept
{
    return utc_now_us();
}

std::int64_t LinuxBoard::boottime_us() noexcept
{
    return dicot::boottime_us();
}

BootId LinuxBoard::boot() noexcept
{
    return boot_id();
}

WaitEnd LinuxBoard::wait_until(std::int64_t until_us, std::int64_t step_us, FunctionRef<bool()> step) noexcept
{
    return dicot::wait_until(until_us, step_us, step);
}

Status LinuxBoard::wake_after(std::int64_t after_s) noexcept
{
    return rtc_.wake_after(after_s);
}

Status LinuxBoard::no_alarm() noexcept
{
    return rtc_.no_alarm();
}

Result<Slept> LinuxBoard::suspend() noexcept
{
    StageWatch::before_sleep();
    const Result<Slept> slept = suspend_board(sys_.c_str());
    StageWatch::after_sleep();
    if (!slept.ok())
        return slept.status();
    return slept.value();
}

bool LinuxBoard::computer_is_there() noexcept
{
    const auto controller = read_line(JoinedPath{"%s/kernel/config/usb_gadget/dicot/UDC", sys_.c_str()}.c_str());
    if (!controller || controller->empty())
        return false;
    const auto state = read_line(JoinedPath{"%s/class/udc/%s/state", sys_.c_str(), controller->c_str()}.c_str());
    return state && state->view() == "configured";
}

} // namespace dicot::app
