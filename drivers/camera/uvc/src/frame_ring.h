// Frames on their way from the thread that fills them to the one that reads them.
#pragma once

#include "dicot/camera/frame.h"
#include "dicot/uvc_parse/payload.h"

#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>

namespace dicot {

/// Slots of one size. One thread fills, one reads, any thread gives back. Nothing is copied and nothing allocated.
class FrameRing
{
public:
    static constexpr int kMostSlots = 16;

    enum class State : std::uint8_t
    {
        kRunning,
        kEnded, ///< nothing more will come; why is known to the filler
    };

    struct Taken
    {
        int slot = -1; ///< -1: none until the deadline, or the stream has ended
        Frame frame;
        State state = State::kRunning;
    };

    /// `memory` is cut into `slots` equal pieces.
    void lay_out(std::span<std::byte> memory, int slots) noexcept;
    std::size_t slot_bytes() const noexcept { return slot_bytes_; }

    /// A new stream: frames of the last one that nobody holds are gone; those that are lent out stay as they are.
    void begin(const CameraMode& mode) noexcept;
    /// No more frames; wait() tells so once it has handed out what is there.
    void end() noexcept;

    /// The filler: a slot to fill. Without a free one the oldest frame that nobody took is given up. -1: all are lent
    /// out.
    int take_free() noexcept;
    std::span<std::byte> room(int slot) const noexcept;
    void publish(int slot, const AssembledFrame& frame) noexcept;
    /// The filler: a frame went by for which there was no slot.
    void miss() noexcept;

    /// The reader: the oldest frame, until `deadline_us` of monotonic_us().
    Taken wait(std::int64_t deadline_us) noexcept;
    void give_back(int slot) noexcept;

private:
    enum class Use : std::uint8_t
    {
        kFree,
        kFilling,
        kReady,
        kLent,
    };
    struct Slot
    {
        Use use = Use::kFree;
        AssembledFrame frame;
        std::uint32_t sequence = 0;
    };

    int oldest_ready() const noexcept;

    std::mutex mutex_;
    std::condition_variable came_;
    std::span<std::byte> memory_;
    std::size_t slot_bytes_ = 0;
    int slots_ = 0;
    std::array<Slot, kMostSlots> slot_{};
    CameraMode mode_;
    State state_ = State::kEnded;
    std::uint32_t sequence_ = 0; ///< of the next frame
    std::uint32_t expected_ = 0; ///< the sequence that the reader would see next if nothing were lost
};

} // namespace dicot
