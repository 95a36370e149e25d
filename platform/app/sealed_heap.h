// The part of a command that finds no memory on its way.
#pragma once

#include "dicot/os/heap_gate.h"

namespace dicot::app {

/// While it lives, operator new serves lent memory only.
class SealedHeap
{
public:
    SealedHeap() noexcept { heap_gate::seal(); }
    SealedHeap(const SealedHeap&) = delete;
    SealedHeap& operator=(const SealedHeap&) = delete;
    ~SealedHeap() { heap_gate::unseal(); }
};

} // namespace dicot::app
