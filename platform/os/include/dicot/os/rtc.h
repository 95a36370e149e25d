// The clock of the board that runs on while it sleeps, and its alarm, which wakes it.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"

#include <cstdint>
#include <optional>

namespace dicot {

/// A device as /dev/rtc0, opened for each call: another program may want it too. Its seconds are those that it shows,
/// since 1970, whatever zone it is set to: they are only ever compared with each other. The alarm goes to the device
/// (RTC_WKALM_SET), and where the device has no such word or may not be opened, to `<sys>/class/rtc/<name>/wakealarm`.
/// Source: Linux, Documentation/admin-guide/rtc.rst. No heap. Fault::kUnavailable: no such clock, no permission, no
/// alarm; each with the remedy.
class Rtc
{
public:
    explicit Rtc(const char* device = "/dev/rtc0", const char* sys = "/sys") noexcept : device_(device), sys_(sys) {}

    Result<std::int64_t> now_s() const noexcept;
    /// The board wakes `after_s` (>= 1) from now. Replaces an alarm that is set.
    Status wake_after(std::int64_t after_s) noexcept;
    Status no_alarm() noexcept;
    /// When it is to ring, in seconds as now_s() has them; none: no alarm is set.
    Result<std::optional<std::int64_t>> alarm_s() const noexcept;

private:
    ShortText<127> device_;
    ShortText<255> sys_;
};

} // namespace dicot
