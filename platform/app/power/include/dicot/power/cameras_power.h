// The cameras between two slots.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"
#include "dicot/os/usb_power.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace dicot::app {

enum class CamerasBetween
{
    kAuto, ///< the kernel suspends a camera that nobody uses
    kOn,   ///< always on: for cameras that come back badly
    kPort, ///< their ports are switched off; where that cannot be, as kAuto
};

/// The power of both cameras, by their ports; kPort wants them bound by port, as one that is off cannot be looked for.
/// Replayed pictures have no port: nothing is done. No heap.
class CamerasPower
{
public:
    static constexpr int kIdleMs = 2000;     ///< of a camera that the kernel suspends
    static constexpr int kAppearMs = 10'000; ///< for a camera whose port was switched on

    explicit CamerasPower(CamerasBetween way, const char* sys = "/sys") noexcept : way_(way), sys_(sys) {}

    /// Which cameras: their USB ports ("1-1.2"), as soon as they are known; the same ones again cost nothing.
    /// Fault::kConfig: no such name.
    Status use(const char* left_port, const char* right_port) noexcept;
    /// After the pair is taken. Each trouble is told once, with the reason; nothing of it stops the series.
    Status off() noexcept;
    /// Before a slot: switched on, and there. Fault::kTryAgain: one does not come back.
    Status on() noexcept;

private:
    Status once(const Status& why) noexcept;
    Status switch_off() noexcept;
    Status switch_on() noexcept;

    CamerasBetween way_;
    ShortText<127> sys_;
    std::array<std::optional<UsbPower>, 2> ports_;
    bool are_on_ = false;
    ShortText<255> told_;
};

} // namespace dicot::app
