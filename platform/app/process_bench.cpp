#include "process_bench.h"

#include "rectify_rig.h"
#include "take_picture.h"

#include "dicot/cloud/render.h"
#include "dicot/codec/encode_cloud.h"

#include <algorithm>
#include <utility>

namespace dicot::app {
namespace {

constexpr int kViewWidth = 640;
constexpr int kLeastViewHeight = 240;
constexpr int kMostViewHeight = 1280;

} // namespace

std::size_t ProcessBudget::stages() const
{
    return std::max({match, encode, preview});
}

PreviewSize preview_size(int width, int height)
{
    return {2 * kViewWidth, std::clamp(kViewWidth * height / width, kLeastViewHeight, kMostViewHeight)};
}

Result<ProcessBudget> process_budget(int width, int height, Pictures pictures, const MatchOptions& options, int workers,
                                     std::size_t scratch_bytes)
{
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (pixels > kMaxCloudPoints)
        return failure(Fault::kConfig,
                       "pictures of %d x %d px can give more points than a cloud file holds (%zu): scale them "
                       "down, with their rig file",
                       width, height, kMaxCloudPoints);
    ProcessBudget budget;
    budget.tables = pictures == Pictures::kRaw ? RectifyTables::reserved_bytes(width, height) : 0;
    Arena kept;
    (void)kept.take<CloudPoint>(pixels);
    budget.kept = kept.peak();

    Arena match;
    for (int picture = 0; picture < 3; ++picture)
        (void)take_picture<Rgb8>(match, width, height);
    Arena before_matching = match;
    if (pictures == Pictures::kRaw)
        (void)take_picture<Rgb8>(before_matching, width, height);
    (void)before_matching.take<std::byte>(scratch_bytes);
    (void)TRY(Matcher::make(width, height, options, kScalarKernels, workers, match));
    budget.match = std::max(match.peak(), before_matching.peak());

    Arena encode;
    (void)encode.take<std::byte>(encode_heap_bytes(pixels));
    budget.encode = encode.peak();

    Arena preview;
    const PreviewSize size = preview_size(width, height);
    (void)take_picture<Rgb8>(preview, size.width, size.height);
    lay_out_render(preview, (size.width + 1) / 2, size.height);
    budget.preview = preview.peak();
    return budget;
}

ProcessBench::ProcessBench(MemoryBlock block, const ProcessBudget& budget)
    : kept(block.bytes().first(budget.kept)), block_(std::move(block)), stages_(block_.bytes().subspan(budget.kept)),
      budget_(budget)
{
}

Result<ProcessBench> ProcessBench::make(int width, int height, Pictures pictures, const MatchOptions& options,
                                        int workers, std::size_t scratch_bytes)
{
    const ProcessBudget budget = TRY(process_budget(width, height, pictures, options, workers, scratch_bytes));
    return ProcessBench{TRY(MemoryBlock::map(budget.kept + budget.stages())), budget};
}

} // namespace dicot::app
