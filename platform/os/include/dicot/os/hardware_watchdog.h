// The watchdog of the board: it resets everything when nobody kicks it.
#pragma once

#include "dicot/base/status.h"

namespace dicot {

/// A device as /dev/watchdog. Source: Linux, Documentation/watchdog/watchdog-api.rst. No heap.
class HardwareWatchdog
{
public:
    HardwareWatchdog() noexcept = default;
    HardwareWatchdog(const HardwareWatchdog&) = delete;
    HardwareWatchdog& operator=(const HardwareWatchdog&) = delete;
    ~HardwareWatchdog(); ///< as let_go()

    /// From here on it bites after `timeout_s` without a kick. Fault::kUnavailable: no such device, no permission,
    /// another program has it. Fault::kConfig: it is no watchdog, or it cannot be told to wait so long; it was let go.
    Status open(const char* device, int timeout_s) noexcept;
    bool held() const noexcept { return descriptor_ >= 0; }
    void kick() noexcept;
    /// A clean end: it is told to rest (magic close), which one with `nowayout` ignores.
    void let_go() noexcept;

private:
    int descriptor_ = -1;
};

} // namespace dicot
