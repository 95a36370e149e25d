#include "dicot/os/lent_heap.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <mutex>

#include <unistd.h>

namespace dicot {
namespace {

constinit thread_local LentHeap* innermost = nullptr;

struct Range
{
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
    BlockHeap* heap = nullptr; ///< null for memory whose lease has ended
    bool holds(std::uintptr_t address) const noexcept { return address >= begin && address < end; }
};

constexpr int kMaxEnded = 64;

/// Every lease of the program, and the memory of the former ones. Fixed, because it is asked from operator delete.
class Leases
{
public:
    bool any() const noexcept { return any_.load(std::memory_order_acquire); }

    bool add(Range lease) noexcept
    {
        const std::lock_guard lock(mutex_);
        if (live_count_ == live_.size())
            return false;
        live_[live_count_++] = lease;
        any_.store(true, std::memory_order_release);
        return true;
    }

    void end(const BlockHeap* heap) noexcept
    {
        const std::lock_guard lock(mutex_);
        const auto live_end = live_.begin() + static_cast<std::ptrdiff_t>(live_count_);
        const auto lease =
            std::find_if(live_.begin(), live_end, [&](const Range& range) { return range.heap == heap; });
        if (lease == live_end)
            return;
        remember(*lease);
        *lease = live_[--live_count_];
    }

    LentHeap::Origin origin_of(std::uintptr_t address) noexcept
    {
        const std::lock_guard lock(mutex_);
        const Range* smallest = nullptr; // a lease may be made of memory that another one gave
        for (std::size_t i = 0; i < live_count_; ++i)
            if (live_[i].holds(address) &&
                (smallest == nullptr || live_[i].end - live_[i].begin < smallest->end - smallest->begin))
                smallest = &live_[i];
        if (smallest != nullptr)
            return {true, smallest->heap};
        const auto ended = std::span{ended_}.first(ended_count_);
        return {std::any_of(ended.begin(), ended.end(), [&](const Range& range) { return range.holds(address); }),
                nullptr};
    }

    void forget_ended(std::uintptr_t address) noexcept
    {
        const std::lock_guard lock(mutex_);
        for (std::size_t i = ended_count_; i-- > 0;)
            if (ended_[i].holds(address))
                drop_ended(i);
    }

private:
    void drop_ended(std::size_t i) noexcept
    {
        std::copy(ended_.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                  ended_.begin() + static_cast<std::ptrdiff_t>(ended_count_),
                  ended_.begin() + static_cast<std::ptrdiff_t>(i));
        --ended_count_;
    }

    /// Joins what overlaps, so that arenas that are lent again and again take one place; a full table loses its oldest.
    void remember(Range range) noexcept
    {
        range.heap = nullptr;
        for (std::size_t i = ended_count_; i-- > 0;) {
            if (ended_[i].begin <= range.end && range.begin <= ended_[i].end) {
                range.begin = std::min(range.begin, ended_[i].begin);
                range.end = std::max(range.end, ended_[i].end);
                drop_ended(i);
            }
        }
        if (ended_count_ == ended_.size())
            drop_ended(0);
        ended_[ended_count_++] = range;
    }

    std::mutex mutex_;
    std::atomic<bool> any_{false};
    std::size_t live_count_ = 0;
    std::size_t ended_count_ = 0;
    std::array<Range, LentHeap::kMaxLeases> live_{};
    std::array<Range, kMaxEnded> ended_{};
};

constinit Leases leases;

} // namespace

LentHeap::LentHeap(std::span<std::byte> memory) noexcept : memory_(memory), heap_(memory), outer_(innermost)
{
    const auto begin = reinterpret_cast<std::uintptr_t>(memory_.data());
    if (!leases.add({begin, begin + memory_.size(), &heap_})) {
        constexpr char kSentence[] = "dicot: more leases of memory at the same time than LentHeap::kMaxLeases\n";
        (void)!::write(STDERR_FILENO, kSentence, sizeof kSentence - 1);
        std::abort();
    }
    innermost = this;
}

LentHeap::~LentHeap()
{
    innermost = outer_;
    leases.end(&heap_);
}

BlockHeap* LentHeap::of_this_thread() noexcept
{
    return innermost == nullptr ? nullptr : &innermost->heap_;
}

LentHeap::Origin LentHeap::origin_of(const void* block) noexcept
{
    return leases.any() ? leases.origin_of(reinterpret_cast<std::uintptr_t>(block)) : Origin{};
}

void LentHeap::forget_ended(const void* block) noexcept
{
    if (leases.any())
        leases.forget_ended(reinterpret_cast<std::uintptr_t>(block));
}

} // namespace dicot
