#include "scanline.h"

#include "paths.h"

#include <utility>

namespace dicot::matching {

void ScanlinePass::lay_out(Arena& arena, const Scene& scene)
{
    const auto axis = static_cast<std::size_t>(scene.axis);
    forward_ = arena.take<std::uint16_t>(static_cast<std::size_t>(scene.width) * axis);
    state_ = arena.take<std::uint16_t>(4 * axis);
}

void ScanlinePass::smooth(const Scene& scene, int y, std::span<std::uint16_t> costs, bool two_sided)
{
    const auto axis = static_cast<std::size_t>(scene.axis);
    const LabRow colours = scene.left.lab(y);
    // What pads the axis before its first disparity never wins.
    const int first = scene.axis - scene.disparities;
    std::uint16_t* const start = state_.data();
    begin_path({start, axis}, first);
    const TwoSidedStep with_right{scene, kBestSteps, start + 3 * axis};
    const auto step = [&](int x, int from, const std::uint16_t* behind, std::uint16_t least, std::uint16_t* ahead) {
        const std::uint16_t* const own = &costs[static_cast<std::size_t>(x) * axis];
        const bool edge =
            from >= 0 && from < scene.width && colour_edge(colours, x, colours, from, two_sided ? kBestEdge : kEdge);
        if (two_sided)
            return with_right(ahead, own, behind, least, edge, scene.right_edges.row(y) + x,
                              from < x ? RightEdges::kBefore : RightEdges::kAfter);
        return scene.kernels->path_step(ahead, own, behind, least, edge ? kSteps.across : kSteps.within, first,
                                        scene.axis);
    };

    const std::uint16_t* behind = start;
    std::uint16_t least = 0;
    for (int x = 0; x < scene.width; ++x) {
        std::uint16_t* const ahead = &forward_[static_cast<std::size_t>(x) * axis];
        least = step(x, x - 1, behind, least, ahead);
        behind = ahead;
    }
    // What is to be smoothed again must be a cost again.
    const std::uint16_t most = two_sided ? kWorstCost : kNoCandidate;
    behind = start;
    least = 0;
    std::uint16_t* ahead = start + axis;
    std::uint16_t* spare = ahead + axis;
    for (int x = scene.width; x-- > 0; std::swap(ahead, spare)) {
        const std::size_t at = static_cast<std::size_t>(x) * axis;
        least = step(x, x + 1, behind, least, ahead);
        for (std::size_t r = 0; r < axis; ++r)
            costs[at + r] =
                costs[at + r] == kNoCandidate ? kNoCandidate : std::min(mean_of(forward_[at + r], ahead[r]), most);
        behind = ahead;
    }
}

} // namespace dicot::matching
