#include "select.h"

#include <algorithm>
#include <cstdlib>

namespace dicot::matching {
namespace {

/// A checked winner must beat its best rival by this part of 255 of the rival's cost.
constexpr int kLeastConfidence = 10;
/// A range so narrow may hold nothing but the winner and what lies beside it: no rival then means nothing.
constexpr int kWithoutRivals = 3;

/// Eq. 15: the vertex of the parabola through three costs, in 1/256 px from the middle one, rounded half up.
int vertex_q8(int before, int at, int after)
{
    const int curvature = before - 2 * at + after;
    if (curvature <= 0)
        return 0;
    const int slope = before - after; // the vertex lies at slope / (2 curvature), within -1/2 .. 1/2
    const int offset = slope * 256 + curvature;
    const int divisor = 2 * curvature;
    return offset >= 0 ? offset / divisor : -((-offset + divisor - 1) / divisor);
}

} // namespace

void Selector::lay_out(Arena& arena, const Scene& scene)
{
    const auto length = static_cast<std::size_t>(scene.width + scene.axis - 1);
    winners_ = arena.take<Winner>(static_cast<std::size_t>(scene.width));
    right_cost_ = arena.take<std::uint16_t>(length);
    right_position_ = arena.take<std::uint16_t>(length);
}

void Selector::select(const Scene& scene, AggregatedRow costs, bool check, SelectedRow& to)
{
    scene.kernels->winners(winners_.data(), costs.data(), scene.width, scene.axis);
    // Partner column x - d of the search frame is entry x + r: E(p, p_d) is the same number seen from either picture.
    if (check)
        scene.kernels->right_winners(right_cost_.data(), right_position_.data(), costs.data(), scene.width, scene.axis);
    for (int x = 0; x < scene.width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        const Winner& winner = winners_[i];
        if (winner.cost == kNoCandidate) {
            to.disparity[i] = kDispMissing;
            to.confidence[i] = 0;
            to.verdict[i] = Verdict::kUnseen;
            continue;
        }
        const std::uint16_t* at = costs.data() + i * static_cast<std::size_t>(scene.axis);
        const int r = winner.position;
        const int d = scene.axis - 1 - r;
        int offset = 0;
        if (d > 0 && d + 1 < scene.disparities && at[r + 1] != kNoCandidate && at[r - 1] != kNoCandidate)
            offset = vertex_q8(at[r + 1], at[r], at[r - 1]);
        to.disparity[i] = static_cast<DispQ8>(d * 256 + offset);

        // How much worse the best rival is, in parts of 255; a pixel without a rival says nothing of itself.
        const int rival = winner.runner_up == kNoCandidate ? winner.cost : winner.runner_up;
        to.confidence[i] = static_cast<std::uint8_t>(rival > 0 ? (rival - winner.cost) * 255 / rival : 0);
        if (winner.runner_up == kNoCandidate && scene.disparities <= kWithoutRivals)
            to.confidence[i] = kLeastConfidence;

        const bool agreed =
            !check || (std::abs(right_position_[i + winner.position] - r) <= 1 && to.confidence[i] >= kLeastConfidence);
        to.verdict[i] = agreed ? Verdict::kMatched : Verdict::kMismatched;
    }
}

} // namespace dicot::matching
