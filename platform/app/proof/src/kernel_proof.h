// What each kernel's file gives to the proof.
#pragma once

#include "stand.h"

namespace dicot::proof {

struct KernelProof
{
    const char* kernel;
    const char* unit;
    /// True when both tables hold the same pointer.
    bool (*same)(const Kernels& a, const Kernels& b);
    /// Small vectors whose answers are worked out in the source.
    void (*work)(const Kernels& tested, Stand& stand, Verdict& verdict);
    /// Many cases against the law.
    void (*compare)(const Kernels& tested, Stand& stand, Dice& dice, Verdict& verdict);
    /// Units per second at a usual size.
    double (*time)(const Kernels& tested, Stand& stand);
};

extern const KernelProof kSupportWeightsProof;
extern const KernelProof kMatchCostProof;
extern const KernelProof kAggregateProof;
extern const KernelProof kNormaliseProof;
extern const KernelProof kPathStepProof;
extern const KernelProof kWinnersProof;
extern const KernelProof kRightWinnersProof;
extern const KernelProof kRemapProof;

} // namespace dicot::proof
