#include "matched.h"

#include "dicot/os/cpu.h"
#include "dicot/os/memory_block.h"
#include "dicot/os/thread_crew.h"

#include <cstdio>
#include <cstdlib>
#include <optional>

namespace dicot {
namespace {

const Kernels& best_kernels()
{
    const CpuFeatures features = cpu_features();
    const Kernels* kernels = features.avx2   ? kernels_for(CpuLevel::kAvx2)
                             : features.neon ? kernels_for(CpuLevel::kNeon)
                                             : nullptr;
    return kernels ? *kernels : kScalarKernels;
}

template <typename T>
T or_stop(Result<T> result)
{
    if (!result.ok()) {
        std::fprintf(stderr, "%s\n", result.status().message());
        std::exit(result.status().exit_code());
    }
    return std::move(result).value();
}

} // namespace

struct Matched::Memory
{
    MemoryBlock block;
};

Matched::Matched(ImageView<const Rgb8> left, ImageView<const Rgb8> right, const MatchOptions& options,
                 const Kernels* kernels, int workers)
    : memory_(std::make_unique<Memory>())
{
    const Kernels& used = kernels ? *kernels : best_kernels();
    Arena measure;
    (void)or_stop(Matcher::make(left.width, left.height, options, used, workers, measure));
    memory_->block = or_stop(MemoryBlock::map(measure.peak()));
    Arena arena(memory_->block.bytes());
    Matcher matcher = or_stop(Matcher::make(left.width, left.height, options, used, workers, arena));
    ThreadCrew crew(workers);
    outcome_ = matcher.match(left, right, crew);
}

Matched::~Matched() = default;

} // namespace dicot
