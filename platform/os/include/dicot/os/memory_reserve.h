// Pages that were taken at the start, for blocks that come and go.
#pragma once

#include "dicot/os/block_heap.h"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>

namespace dicot {

/// While it lives, MemoryBlock::map() of every thread takes its blocks out of `memory` and never from the system, so
/// that a camera that is opened in the third month finds the memory that it found on the first day. One at a time. The
/// memory must outlive every block that came from it; blocks may outlive the reserve.
class MemoryReserve
{
public:
    explicit MemoryReserve(std::span<std::byte> memory) noexcept;
    MemoryReserve(const MemoryReserve&) = delete;
    MemoryReserve& operator=(const MemoryReserve&) = delete;
    ~MemoryReserve();

    /// What a block of `bytes` takes of a reserve at most.
    static constexpr std::size_t bytes_for(std::size_t bytes) noexcept
    {
        constexpr std::size_t kPages = 3 * kPageBytes; // one to align, one to round up, and the block's own header
        return bytes == 0 ? 0 : bytes + kPages;
    }

    std::size_t peak_bytes() const noexcept;
    std::size_t used_bytes() const noexcept;
    /// Blocks that it had no room for.
    std::uint64_t refused() const noexcept;

    static constexpr std::size_t kPageBytes = 4096;

private:
    friend class MemoryBlock;

    std::span<std::byte> take(std::size_t bytes) noexcept;
    bool take_back(std::span<std::byte> block) noexcept;

    std::span<std::byte> memory_;
    mutable std::mutex mutex_;
    BlockHeap heap_;
    std::uint64_t refused_ = 0;
};

} // namespace dicot
