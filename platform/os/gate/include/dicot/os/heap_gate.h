// The gate of the heap: after start-up, `operator new` serves lent memory only.
#pragma once

#include "dicot/os/lent_heap.h"

#include <cstddef>
#include <cstdint>
#include <span>

/// A program that links dicot_heap_gate has its global operator new and delete replaced, and malloc and its kin too. A
/// LentHeap always serves its own thread's operator new. Without one: while the gate is open they are malloc and free;
/// sealed, operator new writes one sentence to stderr and aborts. Blocks from before the seal may be deleted at any
/// time. malloc() is the system's own until seal_for_good(): up to then C libraries (libpng, libjpeg, libc) are bounded
/// at their own doors.
namespace dicot::heap_gate {

/// False under AddressSanitizer and ThreadSanitizer: they bring their own operator new and malloc, seal() then only
/// notes its state, a LentHeap serves nothing, and seal_for_good() changes nothing of malloc.
bool replaces_operator_new() noexcept;

enum class Breach
{
    kStop,  ///< an allocation outside of every lease ends the program
    kCount, ///< it is served by malloc and counted: for tests
};

void seal(Breach breach = Breach::kStop) noexcept;
void unseal() noexcept; ///< for the end of the process, and for tests; after seal_for_good() it does nothing
bool sealed() noexcept;

/// Allocations outside of every lease while the gate was sealed, since the last seal() or seal_for_good().
std::uint64_t breaches() noexcept;

/// From here on the system's heap serves nobody: operator new is as after seal(), whatever seal() and unseal() say
/// later, and malloc, calloc, realloc and their kin are served out of `libraries`, to every thread; a full one gives
/// NULL and ENOMEM. What the system's heap served before may be freed and reallocated at any time. The memory must last
/// until the process ends. Once in a process, which must not fork afterwards.
void seal_for_good(std::span<std::byte> libraries, Breach breach = Breach::kStop) noexcept;
/// Ends that, for the end of the process and for tests: malloc is the system's again. Blocks of the libraries' arena
/// stay valid.
void reopen() noexcept;
bool sealed_for_good() noexcept;

/// What malloc was asked for since seal_for_good().
struct LibrariesHeap
{
    std::uint64_t served = 0;
    std::uint64_t refused = 0; ///< the arena was full
    std::size_t used_bytes = 0;
    std::size_t peak_bytes = 0; ///< BlockHeap::peak_bytes()
};
LibrariesHeap libraries_heap() noexcept;

} // namespace dicot::heap_gate
