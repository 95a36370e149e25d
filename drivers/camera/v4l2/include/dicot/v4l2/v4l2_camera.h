// A camera through the kernel's driver: /dev/video*, buffers of the kernel mapped and lent, nothing copied.
#pragma once

#include "dicot/camera/bandwidth.h"
#include "dicot/camera/camera.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

struct V4l2Node
{
    char path[24] = {}; ///< "/dev/video0": today's number, never a name to keep
    CameraIdentity identity;
};

struct V4l2Nodes
{
    static constexpr int kMost = 16;

    std::array<V4l2Node, kMost> nodes;
    int count = 0;
    int left_out = 0; ///< cameras beyond kMost
    int denied = 0;   ///< nodes that this user may not open
};

/// The nodes of /dev/video0 .. 63 that capture pictures by streaming; nodes of metadata, output and codecs are left
/// out. Each is opened for a moment. No heap.
V4l2Nodes list_v4l2_cameras() noexcept;

/// Where a camera hangs, for the planner; bus -1 of what is not on USB.
struct UsbPlace
{
    int bus = -1;
    UsbSpeed speed = UsbSpeed::kHigh;
};

UsbPlace usb_place_of(const char* port) noexcept;
/// The device and configuration descriptors of the device at `port`, as the kernel keeps them; returns how many bytes
/// were read, 0 if there is no such device.
std::size_t read_usb_descriptors(const char* port, std::span<std::byte> into) noexcept;

/// One thread at a time calls it and lets its leases go. It holds no heap: the tables lie in the object, buffers are
/// the kernel's, allocated and mapped by start() and given back by stop().
///
/// Buffers that are lent when the stream ends stay mapped until their lease goes; meanwhile a new stream may start as
/// long as kSlots are enough for both.
class V4l2Camera final : public Camera
{
public:
    static constexpr int kBuffers = 4; ///< of one stream
    static constexpr int kSlots = 8;
    static constexpr int kMostModes = 96;
    static constexpr int kMostWaitMs = 60'000; ///< next() waits no longer, whatever its deadline

    V4l2Camera() noexcept = default;
    V4l2Camera(const V4l2Camera&) = delete;
    V4l2Camera& operator=(const V4l2Camera&) = delete;
    ~V4l2Camera() override;

    /// `where`: a USB port path ("1-1.2"), a serial number, the bus name of another device ("platform:vivid-000"), or a
    /// node ("/dev/video0"). Fault::kUnavailable: nothing there, no permission, not a camera, no known format.
    Status open(const char* where) noexcept;
    void close() noexcept;
    bool is_open() const noexcept { return descriptor_ >= 0; }
    const char* node() const noexcept { return node_.path; } ///< today's node

    const CameraIdentity& identity() const noexcept override { return node_.identity; }
    std::span<const CameraMode> modes() const noexcept override { return {modes_.data(), mode_count_}; }
    std::span<const ControlRange> controls() const noexcept override { return {controls_.data(), control_count_}; }
    Result<std::int32_t> get(ControlId id) override;
    Result<std::int32_t> set(ControlId id, std::int32_t value) override;

    /// The device must answer with exactly this format and size (another size may be another part of the sensor);
    /// another rate is accepted and stands in the mode of the frames.
    Status start(const CameraMode& mode) override;
    /// Fault::kTryAgain also when all buffers are lent.
    Result<FrameLease> next(std::int64_t deadline_us) override;
    Status stop() override;
    /// Afterwards it streams again if it streamed before. kReopen and kPort look for the device at the same port for at
    /// most 3 s, whatever its node is called then, and refuse another model. Values of controls may be lost by kPort.
    /// kPort needs write access to the device's file in /dev/bus/usb.
    Status shake(Shake how) override;
    void give_back(int slot) noexcept override;

private:
    enum class SlotState : std::uint8_t
    {
        kFree,
        kIdle,   ///< ours, and not lent: to be queued
        kQueued, ///< the driver's
        kLent,
        kOrphan, ///< lent, of a stream that has ended
    };
    struct Slot
    {
        SlotState state = SlotState::kFree;
        std::uint32_t index = 0; ///< the kernel's number
        std::span<std::byte> mapped;
        char flaw[56] = {};
    };

    Status open_node(const char* path) noexcept;
    Status find_again() noexcept;
    Status agree_on(const CameraMode& mode) noexcept;
    Status agree_on_rate(const CameraMode& mode) noexcept;
    Status map_buffers() noexcept;
    void unmap(Slot& slot) noexcept;
    bool queue(Slot& slot) noexcept;
    int count(SlotState state) const noexcept;
    void end_stream() noexcept;
    void release_buffers() noexcept;
    Result<FrameLease> lend(const void* buffer) noexcept;
    Status wait_until(std::int64_t deadline_us, bool& gone) noexcept;
    Status reset_port() noexcept;
    Status failed(const char* what, int error) const noexcept;
    Status check_control(ControlId id) const noexcept;
    Result<std::int32_t> read_control(ControlId id) const noexcept;

    int descriptor_ = -1;
    V4l2Node node_;
    std::array<CameraMode, kMostModes> modes_;
    std::size_t mode_count_ = 0;
    std::array<ControlRange, kControlCount> controls_;
    std::size_t control_count_ = 0;

    CameraMode mode_;
    bool streaming_ = false;
    bool resume_ = false;      ///< a shake failed before the stream was on again
    bool release_due_ = false; ///< the kernel keeps the buffers until the orphans are unmapped (before Linux 4.20)
    bool first_ = true;
    std::uint32_t expected_ = 0; ///< sequence of the next frame
    std::array<Slot, kSlots> slots_;
};

} // namespace dicot
