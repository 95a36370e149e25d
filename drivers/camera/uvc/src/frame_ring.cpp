#include "frame_ring.h"

#include <algorithm>
#include <chrono>

namespace dicot {

void FrameRing::lay_out(std::span<std::byte> memory, int slots) noexcept
{
    slots_ = std::clamp(slots, 1, kMostSlots);
    memory_ = memory;
    slot_bytes_ = memory.size() / static_cast<std::size_t>(slots_);
}

void FrameRing::begin(const CameraMode& mode) noexcept
{
    const std::lock_guard lock(mutex_);
    for (Slot& slot : slot_)
        if (slot.use != Use::kLent)
            slot.use = Use::kFree;
    mode_ = mode;
    state_ = State::kRunning;
    sequence_ = 0;
    expected_ = 0;
}

void FrameRing::end() noexcept
{
    {
        const std::lock_guard lock(mutex_);
        state_ = State::kEnded;
    }
    came_.notify_all();
}

int FrameRing::oldest_ready() const noexcept
{
    int oldest = -1;
    for (int i = 0; i < slots_; ++i) {
        const Slot& slot = slot_[static_cast<std::size_t>(i)];
        if (slot.use == Use::kReady && (oldest < 0 || slot.sequence < slot_[static_cast<std::size_t>(oldest)].sequence))
            oldest = i;
    }
    return oldest;
}

int FrameRing::take_free() noexcept
{
    const std::lock_guard lock(mutex_);
    const auto end = slot_.begin() + slots_;
    const auto free = std::find_if(slot_.begin(), end, [](const Slot& slot) { return slot.use == Use::kFree; });
    const int chosen = free != end ? static_cast<int>(free - slot_.begin()) : oldest_ready();
    if (chosen >= 0)
        slot_[static_cast<std::size_t>(chosen)].use = Use::kFilling;
    return chosen;
}

std::span<std::byte> FrameRing::room(int slot) const noexcept
{
    if (slot < 0)
        return {};
    return memory_.subspan(static_cast<std::size_t>(slot) * slot_bytes_, slot_bytes_);
}

void FrameRing::publish(int slot, const AssembledFrame& frame) noexcept
{
    {
        const std::lock_guard lock(mutex_);
        Slot& filled = slot_[static_cast<std::size_t>(slot)];
        filled.frame = frame;
        filled.sequence = sequence_++;
        filled.use = Use::kReady;
    }
    came_.notify_one();
}

void FrameRing::miss() noexcept
{
    const std::lock_guard lock(mutex_);
    ++sequence_;
}

FrameRing::Taken FrameRing::wait(std::int64_t deadline_us) noexcept
{
    const std::chrono::steady_clock::time_point deadline{std::chrono::microseconds{deadline_us}};
    std::unique_lock lock(mutex_);
    came_.wait_until(lock, deadline, [this] { return state_ == State::kEnded || oldest_ready() >= 0; });
    Taken taken;
    taken.state = state_;
    taken.slot = oldest_ready();
    if (taken.slot < 0)
        return taken;
    Slot& slot = slot_[static_cast<std::size_t>(taken.slot)];
    slot.use = Use::kLent;
    taken.frame = Frame{std::span<const std::byte>{room(taken.slot)}.first(slot.frame.bytes),
                        mode_,
                        slot.frame.verdict,
                        slot.frame.flaw,
                        slot.sequence,
                        slot.sequence - expected_,
                        slot.frame.start_us};
    expected_ = slot.sequence + 1;
    return taken;
}

void FrameRing::give_back(int slot) noexcept
{
    if (slot < 0 || slot >= slots_)
        return;
    const std::lock_guard lock(mutex_);
    slot_[static_cast<std::size_t>(slot)].use = Use::kFree;
}

} // namespace dicot
