#include "dicot/kernels/kernels.h"

namespace dicot {

#ifdef DICOT_HAVE_AVX2
extern const Kernels kAvx2Kernels;
#endif
#ifdef DICOT_HAVE_NEON
extern const Kernels kNeonKernels;
#endif

const Kernels* kernels_for(CpuLevel level)
{
    switch (level) {
    case CpuLevel::kScalar:
        return &kScalarKernels;
    case CpuLevel::kAvx2:
#ifdef DICOT_HAVE_AVX2
        return &kAvx2Kernels;
#else
        return nullptr;
#endif
    case CpuLevel::kNeon:
#ifdef DICOT_HAVE_NEON
        return &kNeonKernels;
#else
        return nullptr;
#endif
    }
    return nullptr;
}

} // namespace dicot
