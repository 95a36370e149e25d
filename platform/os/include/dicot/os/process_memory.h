// How much memory this process holds.
#pragma once

#include "dicot/base/status.h"

#include <cstdint>

namespace dicot {

struct ProcessMemory
{
    std::uint64_t resident_bytes = 0; ///< now (VmRSS)
    std::uint64_t peak_bytes = 0;     ///< the most so far (VmHWM)
    std::uint64_t address_bytes = 0;  ///< of address space, as RLIMIT_AS counts it (VmSize)
};

/// From /proc/self/status. Fault::kOsError where that is not there.
Result<ProcessMemory> process_memory() noexcept;

} // namespace dicot
