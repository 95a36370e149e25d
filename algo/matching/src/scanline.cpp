#include "scanline.h"

#include <algorithm>
#include <cstdlib>

namespace dicot::matching {
namespace {

// In units of normalised cost (kCostMax * 256 is the worst): 0.1 and 0.5 of the 0 .. 2 of eq. 10.
constexpr int kWorst = kCostMax * 256;
constexpr int kSmallStep = kWorst / 20;
constexpr int kLargeStep = kWorst / 4;
/// What the path costs are never above, whatever lies behind: the pixel's own cost and one large step.
static_assert(kWorst + kLargeStep < kNoCandidate);
/// Neighbours that differ by more lie on two sides of a colour edge: 10 CIELAB units.
constexpr int kEdge = 10 * kLabScale;
constexpr int kEdgeDivisor = 8;

bool colour_edge(LabRow row, int i, int j)
{
    const int l = row.la[i].low - row.la[j].low;
    const int a = row.la[i].high - row.la[j].high;
    const int b = row.b[i].low - row.b[j].low;
    return l * l + a * a + b * b > kEdge * kEdge;
}

/// One step of the path over positions `first` .. axis - 1: what lies before them pads the vectors and is no disparity.
/// `behind` and `ahead` have a border entry on both sides; returns the least of `ahead`.
int step(const std::uint16_t* costs, const std::uint16_t* behind, int least_behind, bool edge, std::uint16_t* ahead,
         int first, int axis)
{
    const int small = edge ? kSmallStep / kEdgeDivisor : kSmallStep;
    const int large = edge ? kLargeStep / kEdgeDivisor : kLargeStep;
    const int jump = least_behind + large;
    int least = kNoCandidate;
    // What cannot be seen is neither better nor worse than the worst of what can.
    int unseen = 0;
    for (int r = first; r < axis; ++r)
        unseen = std::max<int>(unseen, costs[r] == kNoCandidate ? 0 : costs[r]);
    for (int r = first; r < axis; ++r) {
        const int own = std::min<int>(costs[r], unseen);
        const int same = behind[r + 1];
        const int near = std::min<int>(behind[r], behind[r + 2]) + small;
        const int path = own + std::min(std::min(same, near), jump) - least_behind;
        ahead[r + 1] = static_cast<std::uint16_t>(path);
        least = std::min(least, path);
    }
    return least;
}

} // namespace

void ScanlinePass::lay_out(Arena& arena, const Scene& scene)
{
    const auto axis = static_cast<std::size_t>(scene.axis);
    forward_ = arena.take<std::uint16_t>(static_cast<std::size_t>(scene.width) * axis);
    state_ = arena.take<std::uint16_t>(2 * (axis + 2));
}

void ScanlinePass::smooth(const Scene& scene, int y, std::span<std::uint16_t> costs)
{
    const auto axis = static_cast<std::size_t>(scene.axis);
    const LabRow colours = scene.left.lab(y);
    std::uint16_t* behind = state_.data();
    std::uint16_t* ahead = state_.data() + axis + 2;
    // The borders of the range never win.
    const int first = scene.axis - scene.disparities;
    for (std::uint16_t* path : {behind, ahead}) {
        std::fill_n(path, first + 1, kNoCandidate);
        path[axis + 1] = kNoCandidate;
    }
    const auto start = [&] { std::fill(behind + 1 + first, behind + 1 + axis, std::uint16_t{0}); };

    start();
    int least = 0;
    for (int x = 0; x < scene.width; ++x) {
        const bool edge = x > 0 && colour_edge(colours, x, x - 1);
        const std::size_t at = static_cast<std::size_t>(x) * axis;
        least = step(&costs[at], behind, least, edge, ahead, first, scene.axis);
        std::copy_n(ahead + 1, axis, &forward_[at]);
        std::swap(behind, ahead);
    }
    start();
    least = 0;
    for (int x = scene.width; x-- > 0;) {
        const bool edge = x + 1 < scene.width && colour_edge(colours, x, x + 1);
        const std::size_t at = static_cast<std::size_t>(x) * axis;
        least = step(&costs[at], behind, least, edge, ahead, first, scene.axis);
        for (std::size_t r = 0; r < axis; ++r)
            if (costs[at + r] != kNoCandidate)
                costs[at + r] = static_cast<std::uint16_t>((forward_[at + r] + ahead[r + 1]) / 2);
        std::swap(behind, ahead);
    }
}

} // namespace dicot::matching
