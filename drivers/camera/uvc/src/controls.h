// Controls of the camera terminal and of the processing unit in the words of ControlId.
#pragma once

#include "usb_port.h"

#include "dicot/camera/control.h"

#include <array>
#include <cstdint>
#include <span>

namespace dicot {

/// What the camera can be set to, read once when it is opened.
class UvcControls
{
public:
    /// Asks for the ranges of every control that the descriptors claim. A control that does not answer is left out; a
    /// camera that times out twice, or takes 3 s for all, is asked no more.
    void read(UsbPort& port, const UvcDevice& device) noexcept;

    std::span<const ControlRange> ranges() const noexcept { return std::span{ranges_}.first(count_); }

    Result<std::int32_t> get(UsbPort& port, const UvcDevice& device, ControlId id) const noexcept;
    Result<std::int32_t> set(UsbPort& port, const UvcDevice& device, ControlId id, std::int32_t value) const noexcept;

private:
    std::array<ControlRange, kControlCount> ranges_{};
    std::size_t count_ = 0;
};

} // namespace dicot
