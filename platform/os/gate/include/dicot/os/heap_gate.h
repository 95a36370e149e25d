// The gate of the heap: after start-up, `operator new` serves lent memory only.
#pragma once

#include "dicot/os/lent_heap.h"

#include <cstdint>

/// A program that links dicot_heap_gate has its global operator new and delete replaced. A LentHeap always serves its
/// own thread. Without one: while the gate is open they are malloc and free; sealed, operator new writes one sentence
/// to stderr and aborts. Blocks from before the seal may be deleted at any time. malloc() itself is not gated: C
/// libraries (libpng, libjpeg, libc) are bounded at their own doors.
namespace dicot::heap_gate {

/// False under AddressSanitizer and ThreadSanitizer: they bring their own operator new, seal() then only notes its
/// state, and a LentHeap serves nothing.
bool replaces_operator_new() noexcept;

enum class Breach
{
    kStop,  ///< an allocation outside of every lease ends the program
    kCount, ///< it is served by malloc and counted: for tests
};

void seal(Breach breach = Breach::kStop) noexcept;
void unseal() noexcept; ///< for the end of the process, and for tests
bool sealed() noexcept;

/// Allocations outside of every lease while the gate was sealed, since the last seal().
std::uint64_t breaches() noexcept;

} // namespace dicot::heap_gate
