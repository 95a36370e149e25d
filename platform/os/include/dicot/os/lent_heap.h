// Memory for libraries that must allocate: a heap over a lent block.
#pragma once

#include "dicot/os/block_heap.h"

#include <cstddef>
#include <span>

namespace dicot {

/// While it lives, `operator new` of the thread that made it is served from `memory`, in programs that link
/// dicot_heap_gate (elsewhere it changes nothing). Leases nest; the innermost serves. A full one throws std::bad_alloc.
/// Blocks may be deleted by any thread, one at a time. Deleting them after the lease's end does nothing, also when the
/// memory is lent again, unless a living block begins at that very place. The memory must outlive the lease, and what a
/// lease served must not be used after it.
class LentHeap
{
public:
    /// Leases that may be held at the same time, all threads together; one more stops the program.
    static constexpr int kMaxLeases = 64;

    explicit LentHeap(std::span<std::byte> memory) noexcept;
    LentHeap(const LentHeap&) = delete;
    LentHeap& operator=(const LentHeap&) = delete;
    ~LentHeap();

    /// BlockHeap::peak_bytes() of this lease; 0 without dicot_heap_gate.
    std::size_t peak_bytes() const noexcept { return heap_.peak_bytes(); }
    std::size_t used_bytes() const noexcept { return heap_.used_bytes(); }

    /// The heap of the calling thread's innermost lease, or null.
    static BlockHeap* of_this_thread() noexcept;

    /// Where a block came from: the gate's question before it frees one.
    struct Origin
    {
        bool lent = false;         ///< the block lies in memory that is or was lent
        BlockHeap* heap = nullptr; ///< null when that lease has ended
    };
    static Origin origin_of(const void* block) noexcept;
    /// malloc gave `block`: if it lies in formerly lent memory, that memory has gone back to the system.
    static void forget_ended(const void* block) noexcept;

private:
    std::span<std::byte> memory_;
    BlockHeap heap_;
    LentHeap* outer_;
};

} // namespace dicot
