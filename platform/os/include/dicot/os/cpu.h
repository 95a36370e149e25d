// What this processor can do.
#pragma once

namespace dicot {

struct CpuFeatures
{
    bool avx2 = false; ///< x86-64: the processor has it and the system saves its registers
    bool neon = false; ///< aarch64: always; armhf: as the kernel reports
};

CpuFeatures cpu_features() noexcept;

} // namespace dicot
