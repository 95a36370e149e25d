// One camera, whatever stands behind it: the kernel's driver (V4L2), libusb (UVC), or recorded pictures.
#pragma once

#include "dicot/base/status.h"
#include "dicot/camera/control.h"
#include "dicot/camera/frame.h"
#include "dicot/camera/mode.h"

#include <cstdint>
#include <span>

namespace dicot {

/// Text of a device: at most N bytes, printable ASCII; anything else stands as '?'. A device may call itself anything.
template <std::size_t N>
struct DeviceText
{
    char text[N + 1] = {};

    void assign(const char* from, std::size_t length) noexcept
    {
        const std::size_t kept = length < N ? length : N;
        std::size_t i = 0;
        for (; i < kept && from[i] != '\0'; ++i)
            text[i] = from[i] >= ' ' && from[i] <= '~' ? from[i] : '?';
        text[i] = '\0';
    }
};

struct CameraIdentity
{
    DeviceText<31> port;   ///< "1-1.2": the place in the USB tree; "replay/left" of recorded pictures
    DeviceText<63> name;   ///< as the device calls itself
    DeviceText<63> serial; ///< empty of most webcams
    std::uint16_t vendor = 0;
    std::uint16_t product = 0;
    const char* driver = ""; ///< "v4l2", "uvc", "replay"
};

/// How hard a camera that stopped delivering is shaken, mildest first.
enum class Shake : std::uint8_t
{
    kRestart, ///< stream off, stream on
    kReopen,  ///< close the device and open it again
    kPort,    ///< reset of the USB port
};

/// Every call returns within a bound of its own, stated in milliseconds by kMostCallMs or by its deadline. Memory is
/// taken when the camera is opened, never later.
class Camera : public FrameOwner
{
public:
    /// Above the sum of what one call can run into, each with the kernel's own bound: SET_INTERFACE (5 s, up to three
    /// times), a port reset, and the driver's own waits.
    static constexpr int kMostCallMs = 30'000;

    virtual ~Camera() = default;

    virtual const CameraIdentity& identity() const noexcept = 0;
    virtual std::span<const CameraMode> modes() const noexcept = 0;
    virtual std::span<const ControlRange> controls() const noexcept = 0;

    /// Fault::kUnavailable: the device does not have the control or is gone.
    virtual Result<std::int32_t> get(ControlId id) = 0;
    /// Sets, and reads back: the value that the device really has.
    virtual Result<std::int32_t> set(ControlId id, std::int32_t value) = 0;

    /// Begins to stream. Fault::kTryAgain: the bus has no bandwidth left for this mode (ENOSPC), ask for less.
    virtual Status start(const CameraMode& mode) = 0;
    /// The next frame, torn ones included. Fault::kTryAgain: none until `deadline_us` (monotonic_us()).
    /// Fault::kUnavailable: the camera is gone.
    virtual Result<FrameLease> next(std::int64_t deadline_us) = 0;
    /// Ends the stream; every buffer that the driver held is back. Leases that are still out stay readable.
    virtual Status stop() = 0;
    virtual Status shake(Shake how) = 0;
};

} // namespace dicot
