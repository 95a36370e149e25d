#include "dicot/os/block_heap.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>

namespace dicot {

/// What stands in front of each block; the span is a gapless row of them. A unit is 16 bytes.
struct BlockHeap::Block
{
    std::uint32_t units;          ///< of this header and what follows it
    std::uint32_t previous_units; ///< of the left neighbour; 0 for the first block
    std::uint32_t stamp;          ///< 0 while free
    std::uint32_t unused;
    Block* next_free; ///< these two lie in the caller's bytes while the block is in use
    Block* previous_free;

    std::byte* start() noexcept { return reinterpret_cast<std::byte*>(this); }
    /// Every place that is asked for is a whole number of units from an aligned one.
    static Block* at(std::byte* start) noexcept { return static_cast<Block*>(static_cast<void*>(start)); }
};

namespace {

constexpr std::size_t kUnit = BlockHeap::kAlignment;
constexpr std::size_t kHeaderBytes = kUnit;
constexpr std::uint32_t kLeastUnits = 2;

std::atomic<std::uint32_t> heaps_made{0};

constexpr std::uint32_t scramble(std::uint32_t x) noexcept
{
    x = (x ^ (x >> 16)) * 0x7feb352dU;
    x = (x ^ (x >> 15)) * 0x846ca68bU;
    return x ^ (x >> 16);
}

} // namespace

BlockHeap::BlockHeap(std::span<std::byte> memory) noexcept : serial_(scramble(++heaps_made))
{
    static_assert(sizeof(Block) <= kLeastUnits * kUnit && kBins == (31 - 2) * 8 + 8);
    const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
    const std::size_t skipped = (kUnit - address % kUnit) % kUnit;
    if (memory.size() < skipped + kLeastUnits * kUnit)
        return;
    const auto units = static_cast<std::uint32_t>(
        std::min<std::uint64_t>((memory.size() - skipped) / kUnit, std::numeric_limits<std::uint32_t>::max()));
    begin_ = memory.data() + skipped;
    end_ = begin_ + std::size_t{units} * kUnit;
    auto* const all = Block::at(begin_);
    all->units = units;
    all->previous_units = 0;
    insert(all);
}

std::size_t BlockHeap::bin_of(std::uint32_t units) noexcept
{
    // Eight bins for each power of two, below 8 units one for each size.
    if (units < 8)
        return units;
    const auto top = static_cast<std::uint32_t>(std::bit_width(units) - 1);
    return (top - 2) * 8 + ((units >> (top - 3)) & 7);
}

std::uint32_t BlockHeap::stamp_of(const Block* block) const noexcept
{
    const auto place = static_cast<std::uint32_t>((reinterpret_cast<const std::byte*>(block) - begin_) / 16);
    return scramble(serial_ ^ place) | 1;
}

BlockHeap::Block* BlockHeap::next_of(Block* block) const noexcept
{
    std::byte* const next = block->start() + std::size_t{block->units} * kUnit;
    return next == end_ ? nullptr : Block::at(next);
}

void BlockHeap::insert(Block* block) noexcept
{
    const std::size_t bin = bin_of(block->units);
    block->stamp = 0;
    block->previous_free = nullptr;
    block->next_free = bins_[bin];
    if (block->next_free != nullptr)
        block->next_free->previous_free = block;
    bins_[bin] = block;
    occupied_[bin / 64] |= std::uint64_t{1} << (bin % 64);
}

void BlockHeap::remove(Block* block) noexcept
{
    const std::size_t bin = bin_of(block->units);
    if (block->next_free != nullptr)
        block->next_free->previous_free = block->previous_free;
    if (block->previous_free != nullptr)
        block->previous_free->next_free = block->next_free;
    else if ((bins_[bin] = block->next_free) == nullptr)
        occupied_[bin / 64] &= ~(std::uint64_t{1} << (bin % 64));
}

BlockHeap::Block* BlockHeap::find(std::uint32_t units) noexcept
{
    // Every block of a bin at or above the one of the rounded-up size is large enough.
    const std::uint32_t step = units < 8 ? 1 : std::uint32_t{1} << (std::bit_width(units) - 4);
    const std::size_t first =
        units > std::numeric_limits<std::uint32_t>::max() - step ? kBins : bin_of(units + step - 1);
    for (std::size_t word = first / 64; first < kBins && word < occupied_.size(); ++word) {
        const std::uint64_t mask = word == first / 64 ? ~std::uint64_t{0} << (first % 64) : ~std::uint64_t{0};
        if (const std::uint64_t found = occupied_[word] & mask; found != 0)
            return bins_[word * 64 + static_cast<std::size_t>(std::countr_zero(found))];
    }
    Block* block = bins_[bin_of(units)];
    while (block != nullptr && block->units < units)
        block = block->next_free;
    return block;
}

/// Cuts a block that is in no bin to `units` and returns the rest, which is in no bin either and belongs to nobody yet.
BlockHeap::Block* BlockHeap::split(Block* block, std::uint32_t units) noexcept
{
    auto* const rest = Block::at(block->start() + std::size_t{units} * kUnit);
    rest->units = block->units - units;
    rest->previous_units = units;
    block->units = units;
    if (Block* const next = next_of(rest); next != nullptr)
        next->previous_units = rest->units;
    return rest;
}

void* BlockHeap::allocate(std::size_t bytes, std::size_t alignment) noexcept
{
    const auto span = static_cast<std::size_t>(end_ - begin_);
    if (bytes > span || alignment > span)
        return nullptr;
    const std::uint64_t wanted = std::max<std::uint64_t>(kLeastUnits, 1 + (std::uint64_t{bytes} + kUnit - 1) / kUnit);
    const std::uint64_t slack = alignment > kUnit ? alignment / kUnit + 1 : 0;
    if (wanted + slack > std::numeric_limits<std::uint32_t>::max())
        return nullptr;
    const auto units = static_cast<std::uint32_t>(wanted);
    Block* block = find(units + static_cast<std::uint32_t>(slack));
    if (block == nullptr)
        return nullptr;
    remove(block);

    if (slack != 0) {
        const auto payload = reinterpret_cast<std::uintptr_t>(block->start()) + kHeaderBytes;
        std::size_t gap = (alignment - payload % alignment) % alignment;
        if (gap != 0 && gap < kLeastUnits * kUnit)
            gap += alignment; // the gap becomes a block of its own
        if (gap != 0) {
            Block* const aligned = split(block, static_cast<std::uint32_t>(gap / kUnit));
            insert(block);
            block = aligned;
        }
    }
    if (block->units >= units + kLeastUnits)
        insert(split(block, units));

    block->stamp = stamp_of(block);
    const std::size_t size = std::size_t{block->units} * kUnit;
    used_bytes_ += size;
    peak_bytes_ = std::max(peak_bytes_, static_cast<std::size_t>(block->start() + size - begin_));
    return block->start() + kHeaderBytes;
}

/// Null unless allocate() of this heap gave it and it has not come back.
BlockHeap::Block* BlockHeap::in_use(const void* given) const noexcept
{
    const auto* const payload = static_cast<const std::byte*>(given);
    if (begin_ == nullptr || payload < begin_ + kHeaderBytes || payload >= end_ ||
        static_cast<std::size_t>(payload - begin_) % kUnit != 0)
        return nullptr;
    auto* const block = Block::at(begin_ + (payload - kHeaderBytes - begin_));
    return block->stamp == stamp_of(block) ? block : nullptr;
}

std::size_t BlockHeap::size_of(const void* given) const noexcept
{
    const Block* const block = in_use(given);
    return block == nullptr ? 0 : std::size_t{block->units} * kUnit - kHeaderBytes;
}

void BlockHeap::release(void* given) noexcept
{
    Block* block = in_use(given);
    if (block == nullptr)
        return;
    used_bytes_ -= std::size_t{block->units} * kUnit;
    block->stamp = 0;

    if (Block* const next = next_of(block); next != nullptr && next->stamp == 0) {
        remove(next);
        block->units += next->units;
    }
    if (block->previous_units != 0) {
        auto* const previous = Block::at(block->start() - std::size_t{block->previous_units} * kUnit);
        if (previous->stamp == 0) {
            remove(previous);
            previous->units += block->units;
            block = previous;
        }
    }
    if (Block* const next = next_of(block); next != nullptr)
        next->previous_units = block->units;
    insert(block);
}

} // namespace dicot
