#include "select.h"

#include <algorithm>
#include <cstdlib>

namespace dicot::matching {
namespace {

/// A checked winner must beat its best rival by this part of 255 of the rival's cost.
constexpr int kLeastConfidence = 10;

struct Winner
{
    int disparity = -1;
    int cost = kNoCandidate;
    int runner_up = kNoCandidate; ///< the least cost that is not next to the winner's
};

/// costs[r], r = axis - 1 - d; the smallest disparity wins a tie.
Winner winner_of(const std::uint16_t* costs, int axis, int disparities)
{
    Winner winner;
    for (int d = 0; d < disparities; ++d) {
        const int cost = costs[axis - 1 - d];
        if (cost < winner.cost) {
            winner.cost = cost;
            winner.disparity = d;
        }
    }
    for (int d = 0; d < disparities; ++d)
        if (std::abs(d - winner.disparity) > 1)
            winner.runner_up = std::min<int>(winner.runner_up, costs[axis - 1 - d]);
    return winner;
}

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
    right_cost_ = arena.take<std::uint16_t>(length);
    right_winner_ = arena.take<std::uint8_t>(length);
}

void Selector::right_winners(const Scene& scene, AggregatedRow costs)
{
    std::fill(right_cost_.begin(), right_cost_.end(), kNoCandidate);
    std::fill(right_winner_.begin(), right_winner_.end(), std::uint8_t{0});
    // Partner column x - d of the search frame is entry x + r: E(p, p_d) is the same number seen from either picture.
    for (int x = 0; x < scene.width; ++x) {
        const std::uint16_t* at = costs.data() + static_cast<std::size_t>(x) * static_cast<std::size_t>(scene.axis);
        for (int r = scene.axis - scene.disparities; r < scene.axis; ++r) {
            const auto entry = static_cast<std::size_t>(x + r);
            // Seen from a fixed partner, x grows with d: strictly less keeps the smallest disparity.
            if (at[r] < right_cost_[entry]) {
                right_cost_[entry] = at[r];
                right_winner_[entry] = static_cast<std::uint8_t>(scene.axis - 1 - r);
            }
        }
    }
}

void Selector::select(const Scene& scene, AggregatedRow costs, bool check, SelectedRow& to)
{
    if (check)
        right_winners(scene, costs);
    for (int x = 0; x < scene.width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        const std::uint16_t* at = costs.data() + i * static_cast<std::size_t>(scene.axis);
        const Winner winner = winner_of(at, scene.axis, scene.disparities);
        if (winner.disparity < 0) {
            to.disparity[i] = kDispMissing;
            to.confidence[i] = 0;
            to.verdict[i] = Verdict::kUnseen;
            continue;
        }
        const int d = winner.disparity;
        const int r = scene.axis - 1 - d;
        int offset = 0;
        if (d > 0 && d + 1 < scene.disparities && at[r + 1] != kNoCandidate && at[r - 1] != kNoCandidate)
            offset = vertex_q8(at[r + 1], at[r], at[r - 1]);
        to.disparity[i] = static_cast<DispQ8>(d * 256 + offset);

        // How much worse the best rival is, in parts of 255; a pixel without a rival says nothing of itself.
        const int rival = winner.runner_up == kNoCandidate ? winner.cost : winner.runner_up;
        to.confidence[i] = static_cast<std::uint8_t>(rival > 0 ? (rival - winner.cost) * 255 / rival : 0);

        const bool agreed = !check || (std::abs(right_winner_[i + static_cast<std::size_t>(r)] - d) <= 1 &&
                                       to.confidence[i] >= kLeastConfidence);
        to.verdict[i] = agreed ? Verdict::kMatched : Verdict::kMismatched;
    }
}

} // namespace dicot::matching
