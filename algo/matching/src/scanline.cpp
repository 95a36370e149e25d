#include "scanline.h"

#include "paths.h"

#include <utility>

namespace dicot::matching {

void ScanlinePass::lay_out(Arena& arena, const Scene& scene)
{
    const auto axis = static_cast<std::size_t>(scene.axis);
    forward_ = arena.take<std::uint16_t>(static_cast<std::size_t>(scene.width) * axis);
    state_ = arena.take<std::uint16_t>(3 * axis);
}

void ScanlinePass::smooth(const Scene& scene, int y, std::span<std::uint16_t> costs)
{
    const auto axis = static_cast<std::size_t>(scene.axis);
    const LabRow colours = scene.left.lab(y);
    // What pads the axis before its first disparity never wins.
    const int first = scene.axis - scene.disparities;
    std::uint16_t* const start = state_.data();
    begin_path({start, axis}, first);
    const auto step = [&](int x, int from, const std::uint16_t* behind, std::uint16_t least, std::uint16_t* ahead) {
        const bool edge = from >= 0 && from < scene.width && colour_edge(colours, x, colours, from);
        return scene.kernels->path_step(ahead, &costs[static_cast<std::size_t>(x) * axis], behind, least,
                                        edge ? kAcrossEdge : kWithinSurface, first, scene.axis);
    };

    const std::uint16_t* behind = start;
    std::uint16_t least = 0;
    for (int x = 0; x < scene.width; ++x) {
        std::uint16_t* const ahead = &forward_[static_cast<std::size_t>(x) * axis];
        least = step(x, x - 1, behind, least, ahead);
        behind = ahead;
    }
    behind = start;
    least = 0;
    std::uint16_t* ahead = start + axis;
    std::uint16_t* spare = ahead + axis;
    for (int x = scene.width; x-- > 0; std::swap(ahead, spare)) {
        const std::size_t at = static_cast<std::size_t>(x) * axis;
        least = step(x, x + 1, behind, least, ahead);
        for (std::size_t r = 0; r < axis; ++r)
            costs[at + r] = costs[at + r] == kNoCandidate ? kNoCandidate : mean_of(forward_[at + r], ahead[r]);
        behind = ahead;
    }
}

} // namespace dicot::matching
