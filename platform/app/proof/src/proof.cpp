#include "dicot/proof/proof.h"

#include "kernel_proof.h"

#include "dicot/os/cpu.h"

#include <algorithm>

namespace dicot::proof {
namespace {

constexpr std::array kProofs = {&kSupportWeightsProof, &kMatchCostProof, &kAggregateProof,    &kNormaliseProof,
                                &kPathStepProof,       &kWinnersProof,   &kRightWinnersProof, &kRemapProof};

Verdict& begin_verdict(Report& report, const Kernels& kernels, const KernelProof& proof)
{
    Verdict& verdict = report.add();
    verdict.level = kernels.name;
    verdict.kernel = proof.kernel;
    verdict.unit = proof.unit;
    return verdict;
}

} // namespace

bool Report::passed() const
{
    return count_ > 0 && std::ranges::all_of(verdicts(), &Verdict::proven);
}

Status prove_law(const Kernels& law, Report& report)
{
    Stand stand = TRY(Stand::set_up());
    for (const KernelProof* proof : kProofs) {
        Verdict& verdict = begin_verdict(report, law, *proof);
        verdict.is_law = true;
        proof->work(law, stand, verdict);
        if (verdict.proven())
            verdict.per_second = proof->time(law, stand);
        verdict.ratio = verdict.proven() ? 1.0 : 0.0;
    }
    return {};
}

Status prove_level(const Kernels& tested, Report& report)
{
    Stand stand = TRY(Stand::set_up());
    for (const KernelProof* proof : kProofs) {
        if (proof->same(tested, kScalarKernels))
            continue;
        Verdict& verdict = begin_verdict(report, tested, *proof);
        Dice dice{report.seed()};
        proof->work(tested, stand, verdict);
        proof->compare(tested, stand, dice, verdict);
        if (!verdict.proven())
            continue;
        verdict.per_second = proof->time(tested, stand);
        verdict.ratio = verdict.per_second / proof->time(kScalarKernels, stand);
    }
    return {};
}

Result<Report> prove_this_processor(std::uint64_t seed)
{
    Report report{seed};
    TRY(prove_law(kScalarKernels, report));
    const CpuFeatures features = cpu_features();
    struct Level
    {
        bool here;
        CpuLevel level;
    };
    for (const Level& level : {Level{features.avx2, CpuLevel::kAvx2}, Level{features.neon, CpuLevel::kNeon}}) {
        if (!level.here)
            continue;
        const Kernels* const kernels = kernels_for(level.level);
        if (kernels == nullptr)
            return failure(Fault::kSoftware, "This program was built without the kernels that this processor can run.");
        TRY(prove_level(*kernels, report));
    }
    return report;
}

} // namespace dicot::proof
