#include "column_paths.h"

#include "paths.h"

#include <algorithm>

namespace dicot::matching {
namespace {

std::size_t size_of(int a, int b)
{
    return static_cast<std::size_t>(a) * static_cast<std::size_t>(b);
}

} // namespace

void ColumnPaths::lay_out(Arena& arena, const Scene& scene, int workers)
{
    const std::size_t row = size_of(scene.width, scene.axis);
    ring_ = arena.take<std::uint16_t>(row * (kChunk + kAhead));
    behind_ = arena.take<std::uint16_t>(row);
    least_ = arena.take<std::uint16_t>(static_cast<std::size_t>(scene.width));
    scratch_ = arena.take<std::uint16_t>(kScratch * size_of(workers, scene.axis));
}

std::span<std::uint16_t> ColumnPaths::costs(const Scene& scene, int y)
{
    const std::size_t row = size_of(scene.width, scene.axis);
    return ring_.subspan(static_cast<std::size_t>(y % (kChunk + kAhead)) * row, row);
}

int ColumnPaths::end_of_costs(const Scene& scene, int chunk) const
{
    return std::min((chunk + 1) * kChunk + kAhead, scene.height);
}

void ColumnPaths::walk(const Scene& scene, int chunk, int worker, int workers)
{
    const int top = chunk * kChunk;
    const int end = std::min(top + kChunk, scene.height);
    const int first = scene.axis - scene.disparities;
    const auto axis = static_cast<std::size_t>(scene.axis);
    std::uint16_t* const start = scratch_.data() + kScratch * size_of(worker, scene.axis);
    begin_path({start, axis}, first);
    const TwoSidedStep two_sided{scene, kBestColumnSteps, start + 3 * axis};
    const auto upwards = [&](int y) { return start + 4 * axis + size_of(y - top, scene.axis); };
    for (int x = scene.width * worker / workers; x < scene.width * (worker + 1) / workers; ++x) {
        const std::size_t column = size_of(x, scene.axis);
        // The step to row y from row y - way. A first step from outside the picture pays for nothing.
        const auto step = [&](int y, int way, const std::uint16_t* behind, std::uint16_t least, std::uint16_t* ahead) {
            const bool edge = colour_edge(scene.left.lab(y), x, scene.left.lab(y - way), x, kBestEdge);
            return two_sided(ahead, costs(scene, y).data() + column, behind, least, edge, scene.right_edges.row(y) + x,
                             way > 0 ? RightEdges::kAbove : RightEdges::kBelow);
        };
        std::uint16_t* ahead = start + axis;
        std::uint16_t* spare = ahead + axis;
        const std::uint16_t* behind = start;
        std::uint16_t least = 0;
        for (int y = end_of_costs(scene, chunk); y-- > top; std::swap(ahead, spare)) {
            std::uint16_t* const to = y < end ? upwards(y) : ahead;
            least = step(y, -1, behind, least, to);
            behind = to;
        }
        behind = top == 0 ? start : &behind_[column];
        least = top == 0 ? std::uint16_t{0} : least_[static_cast<std::size_t>(x)];
        for (int y = top; y < end; ++y, std::swap(ahead, spare)) {
            least = step(y, 1, behind, least, ahead);
            // No path comes this way again.
            std::uint16_t* const both = costs(scene, y).data() + column;
            const std::uint16_t* const up = upwards(y);
            for (std::size_t r = 0; r < axis; ++r)
                both[r] = both[r] == kNoCandidate ? kNoCandidate : mean_of(up[r], ahead[r]);
            behind = ahead;
        }
        std::copy_n(behind, axis, &behind_[column]);
        least_[static_cast<std::size_t>(x)] = least;
    }
}

} // namespace dicot::matching
