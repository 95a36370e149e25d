// What paths along rows and columns share.
#pragma once

#include "cost_rows.h"

#include <algorithm>

namespace dicot::matching {

/// Steps of a path along the row, in units of normalised cost: 0.1 and 0.5 of the 0 .. 2 of eq. 10.
inline constexpr PathPenalty kWithinSurface = {kWorstCost / 20, kWorstCost / 4};
static_assert(kWithinSurface.large <= kMaxPathStep);
/// The same where colours change.
inline constexpr PathPenalty kAcrossEdge = {kWithinSurface.small / 8, kWithinSurface.large / 8};

/// Neighbours that differ by more than 10 CIELAB units lie on two sides of a colour edge.
inline bool colour_edge(LabRow row, int i, LabRow other, int j)
{
    constexpr int kEdge = 10 * kLabScale;
    const int l = row.la[i].low - other.la[j].low;
    const int a = row.la[i].high - other.la[j].high;
    const int b = row.b[i].low - other.b[j].low;
    return l * l + a * a + b * b > kEdge * kEdge;
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

} // namespace dicot::matching
