// Pages that were taken at the start, for blocks that come and go.
#pragma once

#include "dicot/os/block_heap.h"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>

namespace dicot {

/// While it lives, MemoryBlock::map() of every thread takes its blocks out of `memory` and never from the system, so
/// that a camera that is opened in the third month finds the memory that it found on the first day. One at a time: of
/// two the first one serves. The blocks that came from it must go before it does.
class MemoryReserve
{
public:
    static constexpr std::size_t kPageBytes = 4096;

    explicit MemoryReserve(std::span<std::byte> memory) noexcept;
    MemoryReserve(const MemoryReserve&) = delete;
    MemoryReserve& operator=(const MemoryReserve&) = delete;
    ~MemoryReserve();

    /// What a block of `bytes` takes of a reserve at most.
    static constexpr std::size_t bytes_for(std::size_t bytes) noexcept
    {
        return bytes == 0 ? 0 : bytes + 2 * kPageBytes; // to align it, and its header
    }

    std::size_t used_bytes() const noexcept;
    std::size_t peak_bytes() const noexcept;
    std::uint64_t refused() const noexcept; ///< blocks that it had no room for

    /// The one that serves now, or null.
    static MemoryReserve* in_use() noexcept;
    /// Zeroed, aligned to a page; empty: no room.
    std::span<std::byte> take(std::size_t bytes) noexcept;
    void take_back(std::span<std::byte> block) noexcept;

private:
    mutable std::mutex mutex_;
    BlockHeap heap_;
    std::uint64_t refused_ = 0;
};

} // namespace dicot
