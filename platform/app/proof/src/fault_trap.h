// Turns a kernel's step onto a guard page into an answer.
#pragma once

#include "dicot/base/work.h"

#include <signal.h>

namespace dicot::proof {

/// While one lives, SIGSEGV and SIGBUS inside `holds` are caught. Not for several threads.
class FaultTrap
{
public:
    FaultTrap();
    ~FaultTrap();
    FaultTrap(const FaultTrap&) = delete;
    FaultTrap& operator=(const FaultTrap&) = delete;

    /// Runs `step(0)`; false when it touched memory that it may not touch. `step` must own nothing: it is left at once.
    bool holds(TaskRef step);

private:
    struct sigaction old_segv_ = {};
    struct sigaction old_bus_ = {};
};

} // namespace dicot::proof
