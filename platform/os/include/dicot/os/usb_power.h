// Power of one USB device, by the port that it is plugged in.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"
#include "dicot/os/small_file.h"

namespace dicot {

/// A device as "1-1.2": bus 1, port 1 of its root hub, port 2 of the hub there. Source: Linux,
/// Documentation/ABI/testing/sysfs-bus-usb (power/control, <hub>-port<N>/disable). No heap.
class UsbPower
{
public:
    /// Fault::kConfig: `port` is no such name. Looks at nothing yet.
    static Result<UsbPower> at(const char* port, const char* sys = "/sys") noexcept;

    const char* port() const noexcept { return port_.c_str(); }
    bool present() const noexcept; ///< whether a device is there

    /// The kernel suspends it when nobody uses it for `delay_ms`; keep_on(): never. Fault::kUnavailable: no device,
    /// no permission.
    Status let_sleep(int delay_ms) noexcept;
    Status keep_on() noexcept;
    /// Whether the kernel has put it to sleep. Fault::kUnavailable.
    Result<bool> sleeps() const noexcept;

    /// Whether the hub takes orders for this port (and for its USB 3 twin, which feeds the same socket).
    /// Fault::kUnavailable, with the reason: the hub or the kernel (before 6.0) does not, no permission.
    Status can_switch() const noexcept;
    /// The port is dead for the bus; whether its 5 V go too is the hub's matter. Fault::kUnavailable.
    Status off() noexcept;
    /// The device appears some time later: wait_for_device().
    Status on() noexcept;

private:
    JoinedPath disable_path(bool of_twin) const noexcept;
    Status set_disable(const char* value) noexcept;

    ShortText<31> port_;
    ShortText<31> hub_;       ///< "1-1", "usb1"
    ShortText<31> interface_; ///< "1-1:1.0", "1-0:1.0"
    int number_ = 0;          ///< of the port on that hub
    ShortText<127> sys_;
};

/// Until the device at `port` is there and configured. Fault::kTryAgain: not within `wait_ms`. Fault::kConfig: no port.
Status wait_for_device(const char* port, int wait_ms, const char* sys = "/sys") noexcept;

} // namespace dicot
