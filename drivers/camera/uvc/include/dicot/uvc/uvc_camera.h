// A camera of the USB Video Class straight through libusb, for boards and cameras where the kernel's driver will not
// do.
#pragma once

#include "dicot/camera/bandwidth.h"
#include "dicot/camera/camera.h"
#include "dicot/uvc_parse/descriptors.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

namespace dicot {

struct UvcOptions
{
    static constexpr int kFewestSlots = 4;
    static constexpr int kMostSlots = 16;

    int slots = 6;              ///< frames that may be under way, waiting or lent out at a time
    std::size_t slot_bytes = 0; ///< largest frame that will be asked for; 0: of the largest mode of the device
};

/// Two cameras share one libusb context and the one thread that serves it, so neither starves while the application
/// holds frames. The kernel's driver is detached at open and given back when the camera is let go.
class UvcCamera final : public Camera
{
public:
    /// `which` is a USB port path or a serial number. Takes all memory that the camera will ever need: see
    /// memory_bytes(). Fault::kUnavailable: no such camera, no right to open it, or another program has it.
    /// Fault::kConfig: `options` are out of range.
    static Result<std::unique_ptr<UvcCamera>> open(std::string_view which, const UvcOptions& options = {});

    UvcCamera(const UvcCamera&) = delete;
    UvcCamera& operator=(const UvcCamera&) = delete;
    ~UvcCamera() override;

    /// What open() would map for this device.
    static std::size_t memory_bytes(const UvcDevice& device, const UvcOptions& options) noexcept;

    const UvcDevice& device() const noexcept;
    UsbSpeed speed() const noexcept;
    int bus() const noexcept;

    /// Bytes of one interval that the camera wants for a mode, for the bandwidth plan; asks it, commits to nothing, and
    /// must not be called while it streams. Fault::kTryAgain: it refuses the mode, or streams.
    Result<std::uint32_t> payload_bytes(const CameraMode& mode);

    /// The alternate setting of the bandwidth plan, from the next start() on. The camera is asked to make its payloads
    /// fit. Many that insist on larger ones cut them to the setting all the same; those that do not deliver torn frames
    /// alone. 0: the smallest setting that fits.
    void use_alternate(std::uint8_t number) noexcept;
    /// The alternate setting in use; 0 while nothing streams and of bulk cameras.
    std::uint8_t alternate() const noexcept;

    const CameraIdentity& identity() const noexcept override;
    std::span<const CameraMode> modes() const noexcept override;
    std::span<const ControlRange> controls() const noexcept override;

    /// Fault::kTryAgain: the camera says that it is not the moment (an exposure time while exposure is automatic).
    Result<std::int32_t> get(ControlId id) override;
    Result<std::int32_t> set(ControlId id, std::int32_t value) override;

    Status start(const CameraMode& mode) override;
    /// Frames that nobody asked for in time are dropped, oldest first, and counted in Frame::lost_before. A stream that
    /// the device broke off (stall, endless errors) is Fault::kTryAgain with the reason, at once: shake it.
    Result<FrameLease> next(std::int64_t deadline_us) override;
    Status stop() override;
    Status shake(Shake how) override;
    void give_back(int slot) noexcept override;

private:
    struct Works;
    explicit UvcCamera(std::unique_ptr<Works> works) noexcept;

    std::unique_ptr<Works> works_;
};

} // namespace dicot
