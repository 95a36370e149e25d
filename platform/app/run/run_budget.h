// What months alone take: every byte of memory that `dicot run` will ever have, found before it takes any.
#pragma once

#include "../config/config.h"
#include "../process_bench.h"

#include "dicot/base/status.h"

#include <cstddef>

namespace dicot::app {

/// In bytes. Resident is what its pages take of the board's memory once everything was used to its end; address space
/// is what RLIMIT_AS counts.
struct RunBudget
{
    std::size_t program = 0;   ///< code and data of program and libraries, what they took at the start
    std::size_t clouds = 0;    ///< ProcessBudget::total(): tables, points, the stages of a cloud
    std::size_t store = 0;     ///< the catalogue's block and the desk that records are read on
    std::size_t office = 0;    ///< records, names, camera objects of one slot
    std::size_t libraries = 0; ///< what malloc serves after the seal
    std::size_t frames = 0;    ///< the pictures that cameras keep
    std::size_t stacks = 0;    ///< pages of the threads' stacks that they touch
    std::size_t address_space = 0;

    std::size_t resident() const { return program + clouds + store + office + libraries + frames + stacks; }
};

/// What this process has now, before any of the above is taken: to be asked first.
struct BareProcess
{
    std::size_t resident_bytes = 0;
    std::size_t address_bytes = 0;
    /// Fault::kOsError: /proc is not there.
    static Result<BareProcess> measure();
};

/// `clouds` for pictures of `width` x `height` px and `threads` workers; `recorded_bytes`: of one frame of recorded
/// pictures, 0 for cameras. Fault::kConfig: it is more than run.most_memory_mib; the sentence says both.
Result<RunBudget> run_budget(const Config& config, const BareProcess& bare, const ProcessBudget& clouds, int width,
                             int height, int threads);

} // namespace dicot::app
