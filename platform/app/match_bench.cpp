#include "match_bench.h"

#include "take_picture.h"

namespace dicot::app {

Result<MatchBudget> match_budget(int width, int height, const MatchOptions& options, int workers)
{
    MatchBudget budget;
    Arena pictures;
    Arena matcher;
    Arena output;
    (void)TRY(Matcher::make(width, height, options, kScalarKernels, workers, matcher));
    (void)take_picture<Rgb8>(pictures, width, height);
    (void)take_picture<Rgb8>(pictures, width, height);
    (void)take_picture<std::uint16_t>(output, width, height);
    budget.pictures = pictures.peak();
    budget.matcher = matcher.peak();
    budget.output = output.peak();
    return budget;
}

Result<MatchBench> MatchBench::make(int width, int height, const MatchOptions& options, const Kernels& kernels,
                                    int workers)
{
    const MatchBudget budget = TRY(match_budget(width, height, options, workers));
    MemoryBlock block = TRY(MemoryBlock::map(budget.total()));
    Arena arena(block.bytes());
    const auto left = take_picture<Rgb8>(arena, width, height);
    const auto right = take_picture<Rgb8>(arena, width, height);
    const auto output = take_picture<std::uint16_t>(arena, width, height);
    Matcher matcher = TRY(Matcher::make(width, height, options, kernels, workers, arena));
    MatchBench bench(std::move(block), std::move(matcher));
    bench.left = left;
    bench.right = right;
    bench.output = output;
    return bench;
}

} // namespace dicot::app
