#include "dicot/os/cpu.h"

#if defined(__arm__)
#include <asm/hwcap.h>
#include <sys/auxv.h>
#endif

namespace dicot {

CpuFeatures cpu_features() noexcept
{
    CpuFeatures features;
#if defined(__x86_64__)
    features.avx2 = __builtin_cpu_supports("avx2") != 0;
#elif defined(__aarch64__)
    features.neon = true;
#elif defined(__arm__)
    features.neon = (getauxval(AT_HWCAP) & HWCAP_NEON) != 0;
#endif
    return features;
}

} // namespace dicot
