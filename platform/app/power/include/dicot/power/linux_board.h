// The board that the program runs on.
#pragma once

#include "dicot/os/rtc.h"
#include "dicot/power/rest.h"

namespace dicot::app {

class LinuxBoard final : public Board
{
public:
    explicit LinuxBoard(const char* rtc, const char* sys = "/sys") noexcept : rtc_(rtc, sys), sys_(sys) {}

    std::int64_t now_us() noexcept override;
    std::int64_t boottime_us() noexcept override;
    BootId boot() noexcept override;
    WaitEnd wait_until(std::int64_t until_us, std::int64_t step_us, FunctionRef<bool()> step) noexcept override;
    Status wake_after(std::int64_t after_s) noexcept override;
    Status no_alarm() noexcept override;
    Result<Slept> suspend() noexcept override;
    /// What the USB device controller says that the gadget "dicot" is bound to.
    bool computer_is_there() noexcept override;

private:
    Rtc rtc_;
    ShortText<127> sys_;
};

} // namespace dicot::app
