// A frame is borrowed: it comes back to its camera on every path, and says in itself whether it may be trusted.
#pragma once

#include "dicot/camera/mode.h"

#include <cstdint>
#include <span>
#include <utility>

namespace dicot {

enum class FrameVerdict : std::uint8_t
{
    kWhole,     ///< every byte as the camera sent it
    kTorn,      ///< bytes are missing or the transport reported an error
    kCancelled, ///< the stream was stopped, or the camera went away, before it was complete
    kWarmingUp, ///< every byte is there, but the picture is not yet as it will stay
};
const char* name_of(FrameVerdict verdict) noexcept;

struct Frame
{
    std::span<const std::byte> bytes;
    CameraMode mode;
    FrameVerdict verdict = FrameVerdict::kCancelled;
    const char* flaw = "";         ///< what tore it, for the record ("error bit", "612 of 614400 bytes")
    std::uint32_t sequence = 0;    ///< counts frames of this stream, gaps and all
    std::uint32_t lost_before = 0; ///< frames known to be lost since the one before
    std::int64_t start_us = 0;     ///< start of exposure, as far as the device tells; the clock of monotonic_us()
};

/// Who takes a frame's buffer back.
class FrameOwner
{
public:
    virtual void give_back(int slot) noexcept = 0;

protected:
    ~FrameOwner() = default;
};

/// A borrowed frame. Letting go gives the buffer back to the camera; the camera must outlive it.
class [[nodiscard]] FrameLease
{
public:
    FrameLease(FrameOwner& owner, int slot, const Frame& frame) noexcept : owner_(&owner), slot_(slot), frame_(frame) {}
    FrameLease(FrameLease&& other) noexcept
        : owner_(std::exchange(other.owner_, nullptr)), slot_(other.slot_), frame_(other.frame_)
    {
    }
    FrameLease& operator=(FrameLease&& other) noexcept
    {
        if (this != &other) {
            let_go();
            owner_ = std::exchange(other.owner_, nullptr);
            slot_ = other.slot_;
            frame_ = other.frame_;
        }
        return *this;
    }
    FrameLease(const FrameLease&) = delete;
    FrameLease& operator=(const FrameLease&) = delete;
    ~FrameLease() { let_go(); }

    const Frame& operator*() const noexcept { return frame_; }
    const Frame* operator->() const noexcept { return &frame_; }
    /// Who holds a frame may know better than the driver what it is worth.
    void judge(FrameVerdict verdict) noexcept { frame_.verdict = verdict; }

private:
    void let_go() noexcept
    {
        // The analyzer takes a lease that TRY() left unmade for one that has to be destroyed.
        if (owner_ != nullptr) // NOLINT(clang-analyzer-core.UndefinedBinaryOperatorResult)
            std::exchange(owner_, nullptr)->give_back(slot_);
    }

    FrameOwner* owner_;
    int slot_;
    Frame frame_;
};

} // namespace dicot
