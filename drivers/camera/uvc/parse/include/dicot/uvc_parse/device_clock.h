// When a frame began, in the host's time.
#pragma once

#include <cstdint>

namespace dicot {

/// The two clock readings of a payload header (UVC 2.4.3.3): `pts`, the device's clock when the capture began, and
/// `stc`, the same clock when this payload was put on the bus; ticks of dwClockFrequency, both running over at 2^32.
struct DeviceTime
{
    std::uint32_t pts = 0;
    std::uint32_t stc = 0;
};

/// `arrival_us` less the age that the device gives the frame. A device without a clock rate, or one that claims an age
/// of more than a second (a clock reset, a PTS ahead of the STC, a PTS of another clock), is not believed:
/// `arrival_us`.
///
/// No fit over many frames: the error is the time that a payload lies in the device and in the host's controller, well
/// below a millisecond on a bus that is not full, and the same for two cameras of one kind.
constexpr std::int64_t start_of_frame_us(DeviceTime time, std::uint32_t clock_hz, std::int64_t arrival_us) noexcept
{
    const std::uint32_t age = time.stc - time.pts;
    if (clock_hz == 0 || age > clock_hz)
        return arrival_us;
    return arrival_us - static_cast<std::int64_t>(std::uint64_t{age} * 1'000'000u / clock_hz);
}

} // namespace dicot
