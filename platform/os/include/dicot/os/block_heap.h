// A heap over one span of memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// Serves blocks of any size out of one span and reuses what comes back: segregated fits, and free neighbours melt at
/// once. Constant time but for the last search before it refuses. Each block costs 16 bytes more. Not for several
/// threads at once.
class BlockHeap
{
public:
    static constexpr std::size_t kAlignment = 16;

    /// Of a span above 64 GiB the first 64 GiB are used.
    explicit BlockHeap(std::span<std::byte> memory) noexcept;
    BlockHeap(const BlockHeap&) = delete;
    BlockHeap& operator=(const BlockHeap&) = delete;

    /// At least `bytes` bytes aligned to `alignment` (a power of two), or null when no hole is large enough.
    void* allocate(std::size_t bytes, std::size_t alignment = kAlignment) noexcept;
    /// Takes back what allocate() of this heap gave. Anything else, also a block that came back already, changes
    /// nothing: each block in use carries a stamp of its heap and place.
    void release(void* block) noexcept;
    /// How many bytes a block in use may hold, at least as many as were asked for; 0 of anything else.
    std::size_t size_of(const void* block) const noexcept;

    std::size_t used_bytes() const noexcept { return used_bytes_; } ///< now, headers included
    /// How far into the span blocks ever reached. A span of this size is cut differently and may be a little too small.
    std::size_t peak_bytes() const noexcept { return peak_bytes_; }

private:
    struct Block;
    static constexpr std::size_t kBins = 240;

    static std::size_t bin_of(std::uint32_t units) noexcept;
    Block* in_use(const void* block) const noexcept;
    std::uint32_t stamp_of(const Block* block) const noexcept;
    Block* next_of(Block* block) const noexcept;
    Block* find(std::uint32_t units) noexcept;
    void insert(Block* block) noexcept;
    void remove(Block* block) noexcept;
    Block* split(Block* block, std::uint32_t units) noexcept;

    std::byte* begin_ = nullptr;
    std::byte* end_ = nullptr;
    std::uint32_t serial_ = 0;
    std::size_t used_bytes_ = 0;
    std::size_t peak_bytes_ = 0;
    std::array<std::uint64_t, (kBins + 63) / 64> occupied_{};
    std::array<Block*, kBins> bins_{};
};

} // namespace dicot
