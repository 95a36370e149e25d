// Recorded pictures as a camera.
#pragma once

#include "dicot/camera/camera.h"
#include "dicot/os/memory_block.h"
#include "dicot/replay/replay_script.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

struct ReplayOptions
{
    const char* port = "replay"; ///< "replay/left": the place that the camera is bound by
    ReplayScript script;
    /// Frame k begins at epoch + skew + k intervals and shows file k modulo their number, for every camera with the
    /// same epoch: pairs stay pairs, whenever either camera was started.
    std::int64_t epoch_us = 0;
    /// Where time stands, shared by all cameras of a rig: waiting moves it on, nobody sleeps, every run is the same.
    /// Null: monotonic_us(), and next() sleeps.
    std::int64_t* virtual_now_us = nullptr;
};

/// JPEG files arrive as their bytes (MJPEG), raw frames ("left-640x480_3.yuyv": the size stands in the name) as YUYV,
/// all other pictures that dicot reads as RGB24, unaltered. All files are of one format and one size.
///
/// One mode is offered; another rate may be asked for. A reader who is late loses nothing: frames come in their order,
/// with the times at which they were due. One thread at a time.
class ReplayCamera final : public Camera
{
public:
    static constexpr int kSlots = 4;
    static constexpr int kMostWaitMs = 60'000; ///< next() waits no longer, whatever its deadline

    ReplayCamera() noexcept = default;
    ReplayCamera(const ReplayCamera&) = delete;
    ReplayCamera& operator=(const ReplayCamera&) = delete;
    ~ReplayCamera() override = default;

    /// `files`, and the paths in it, are borrowed as long as the camera lives; each is looked at now and read again
    /// when its frame is due. Takes the memory of kSlots frames. Fault::kNoInput, kBadData: as picture_size() says; no
    /// files; files that are not of one format and size. Fault::kConfig: a script that does not suit the files.
    Status open(std::span<const char* const> files, const ReplayOptions& options) noexcept;

    std::size_t memory_bytes() const noexcept { return memory_.bytes().size(); } ///< of its frames

    const CameraIdentity& identity() const noexcept override { return identity_; }
    std::span<const CameraMode> modes() const noexcept override { return {&offered_, offered_.width > 0 ? 1U : 0U}; }
    std::span<const ControlRange> controls() const noexcept override
    {
        return {ranges_.data(), static_cast<std::size_t>(options_.script.control_count)};
    }
    Result<std::int32_t> get(ControlId id) override;
    Result<std::int32_t> set(ControlId id, std::int32_t value) override;

    Status start(const CameraMode& mode) override;
    /// A file that can no longer be read makes a torn frame.
    Result<FrameLease> next(std::int64_t deadline_us) override;
    Status stop() override;
    /// Streams again afterwards if it streamed before. Fault::kUnavailable: the camera stays gone.
    Status shake(Shake how) override;
    void give_back(int slot) noexcept override;

private:
    struct Slot
    {
        bool lent = false;
        std::span<std::byte> bytes;
        char flaw[56] = {};
    };

    std::int64_t now_us() const noexcept;
    void wait_until(std::int64_t when_us) noexcept;
    std::int64_t due_us() const noexcept;
    const ReplayEvent* event_now() const noexcept;
    Frame fill(Slot& slot, bool torn) noexcept;
    int control_at(ControlId id) const noexcept;
    Status gone() const noexcept;

    CameraIdentity identity_;
    ReplayOptions options_;
    std::span<const char* const> files_;
    MemoryBlock memory_;
    std::array<Slot, kSlots> slots_;
    CameraMode offered_;
    CameraMode mode_;
    std::array<ControlRange, kControlCount> ranges_;
    std::array<std::int32_t, kControlCount> values_{};

    bool streaming_ = false;
    bool resume_ = false;                 ///< a shake failed before the stream was on again
    const ReplayEvent* ailing_ = nullptr; ///< the hang or the unplugging that lasts
    std::uint32_t starts_ = 0;
    std::int64_t index_ = 0;     ///< of the next frame, since the epoch
    std::uint32_t sequence_ = 0; ///< of the next frame, since the start
    std::uint32_t lost_ = 0;     ///< since the last frame that arrived
    std::uint32_t counted_ = 0;  ///< frames since the camera was opened
};

} // namespace dicot
