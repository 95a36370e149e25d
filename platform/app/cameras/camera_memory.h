// What the two cameras of a configuration take each time that they are opened.
#pragma once

#include "../config/config.h"

#include <cstddef>

namespace dicot::app {

/// In bytes, both cameras together.
struct CameraMemory
{
    std::size_t frames = 0; ///< blocks of pages (MemoryReserve::bytes_for() of each)
    std::size_t kernels =
        0; ///< address space alone: frames that the kernel keeps and shows; where it does, `frames` stays unused
    std::size_t office = 0; ///< of recorded pictures: their names, by operator new

    /// Recorded pictures are opened and measured. Of cameras it is what UVC allows at USB 2, or what those that are
    /// plugged in now want if that is more. Errors: those of RigStream::open() for recorded pictures; Fault::kConfig:
    /// there are too many of them.
    static Result<CameraMemory> measure(const Config& config);
};

} // namespace dicot::app
