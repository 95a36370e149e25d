// What paths along rows and columns share.
#pragma once

#include "cost_rows.h"

#include <algorithm>

namespace dicot::matching {

/// Steps of a path.
struct PathSteps
{
    PathPenalty within; ///< one surface
    PathPenalty across; ///< a colour edge, where surfaces may end: an eighth of it
};

/// `small` and `large` in 1/1000 of the worst cost.
constexpr PathSteps steps_of(int small, int large)
{
    const auto part = [](int thousandths) { return static_cast<std::uint16_t>(kWorstCost * thousandths / 1000); };
    const PathPenalty within = {part(small), part(large)};
    return {within, {static_cast<std::uint16_t>(within.small / 8), static_cast<std::uint16_t>(within.large / 8)}};
}

/// Along the row: 0.1 and 0.5 of the 0 .. 2 of eq. 10.
inline constexpr PathSteps kSteps = steps_of(50, 250);
/// Those of kBest. Down the columns small ones are cheap: ground slants there.
inline constexpr PathSteps kBestSteps = steps_of(60, 275);
inline constexpr PathSteps kBestColumnSteps = steps_of(10, 275);
static_assert(kSteps.within.large <= kMaxPathStep && kBestSteps.within.large <= kMaxPathStep);

/// Neighbours that differ by more lie on two sides of a colour edge, CIELAB units.
inline constexpr int kEdge = 10;
inline constexpr int kBestEdge = 12;

inline bool colour_edge(LabRow row, int i, LabRow other, int j, int least)
{
    const int l = row.la[i].low - other.la[j].low;
    const int a = row.la[i].high - other.la[j].high;
    const int b = row.b[i].low - other.b[j].low;
    return l * l + a * a + b * b > least * least * kLabScale * kLabScale;
}

/// What lies behind the first pixel of a path: nothing, and no disparity for what pads the axis before `first`.
inline void begin_path(std::span<std::uint16_t> axis, int first)
{
    std::ranges::fill(axis, std::uint16_t{0});
    std::fill_n(axis.begin(), first, kNoCandidate);
}

/// Floor of the mean, without a wider type: a vector of 16-bit lanes holds more.
inline std::uint16_t mean_of(std::uint16_t a, std::uint16_t b)
{
    return static_cast<std::uint16_t>((a & b) + ((a ^ b) >> 1));
}

/// One step of a path that moves in both pictures at once.
struct TwoSidedStep
{
    const Scene& scene;
    PathSteps steps;
    std::uint16_t* scratch; ///< [axis]

    /// path_step of the kernels with the steps of an edge for every position where the left picture has one, or the
    /// right one on the path's side: `sides` are those of RightEdges from position 0 on.
    std::uint16_t operator()(std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                             std::uint16_t least, bool left_edge, const std::uint8_t* sides, unsigned side) const;
};

} // namespace dicot::matching
