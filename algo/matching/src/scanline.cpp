#include "scanline.h"

#include <algorithm>

namespace dicot::matching {
namespace {

/// In units of normalised cost: 0.1 and 0.5 of the 0 .. 2 of eq. 10.
constexpr PathPenalty kWithin = {kWorstCost / 20, kWorstCost / 4};
static_assert(kWithin.large <= kMaxPathStep);
constexpr int kEdgeDivisor = 8;
constexpr PathPenalty kAcrossEdge = {kWithin.small / kEdgeDivisor, kWithin.large / kEdgeDivisor};
/// Neighbours that differ by more lie on two sides of a colour edge: 10 CIELAB units.
constexpr int kEdge = 10 * kLabScale;

bool colour_edge(LabRow row, int i, int j)
{
    const int l = row.la[i].low - row.la[j].low;
    const int a = row.la[i].high - row.la[j].high;
    const int b = row.b[i].low - row.b[j].low;
    return l * l + a * a + b * b > kEdge * kEdge;
}

/// Floor of the mean, without a wider type: a vector of 16-bit lanes holds more.
std::uint16_t mean(std::uint16_t a, std::uint16_t b)
{
    return static_cast<std::uint16_t>((a & b) + ((a ^ b) >> 1));
}

} // namespace

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
    std::fill_n(start, first, kNoCandidate);
    std::fill(start + first, start + axis, std::uint16_t{0});
    const auto step = [&](int x, int from, const std::uint16_t* behind, std::uint16_t least, std::uint16_t* ahead) {
        const bool edge = from >= 0 && from < scene.width && colour_edge(colours, x, from);
        return scene.kernels->path_step(ahead, &costs[static_cast<std::size_t>(x) * axis], behind, least,
                                        edge ? kAcrossEdge : kWithin, first, scene.axis);
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
            costs[at + r] = costs[at + r] == kNoCandidate ? kNoCandidate : mean(forward_[at + r], ahead[r]);
        behind = ahead;
    }
}

} // namespace dicot::matching
