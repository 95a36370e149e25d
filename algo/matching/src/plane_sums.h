// A plane of least squares through weighted points, in integers.
#pragma once

#include "point_sums.h"

#include <algorithm>
#include <cstdint>

namespace dicot::matching {

/// Points (dx, dy, rise) around a centre: |dx|, |dy| <= 8 px, |rise| < 2^17 in 1/4096 px, 81 of them at most, weights
/// up to 2^7 kMostWeight. Every sum is below 2^50.
struct PlaneSums : PointSums
{
    static constexpr int kMostWeight = 65535;

    /// 1/4096 px, and a px.
    struct Plane
    {
        std::int32_t centre, across, down;
    };

    /// Needs at least one point. Means have 8 fraction bits (rise: 12), second moments 16: those of positions are below
    /// 2^23, those with the rise below 2^29.
    Plane plane() const
    {
        constexpr std::int64_t kStiffness = 1 << 15; // half a px^2: a narrow strip makes no slope
        constexpr std::int64_t kSteepest = 1 << 12;
        const std::int64_t mean_x = x * 256 / one;
        const std::int64_t mean_y = y * 256 / one;
        const std::int64_t mean_rise = rise / one;
        const std::int64_t across2 = xx * 65536 / one - mean_x * mean_x + kStiffness;
        const std::int64_t down2 = yy * 65536 / one - mean_y * mean_y + kStiffness;
        const std::int64_t both = xy * 65536 / one - mean_x * mean_y;
        const std::int64_t across_rise = x_rise * 16 / one - mean_x * mean_rise / 16;
        const std::int64_t down_rise = y_rise * 16 / one - mean_y * mean_rise / 16;
        // Positive: rounded means cost less than the stiffness.
        const std::int64_t determinant = across2 * down2 - both * both;
        const auto slope = [&](std::int64_t numerator) {
            return std::clamp(numerator / (determinant / 4096 + 1), -kSteepest, kSteepest);
        };
        const std::int64_t across = slope(across_rise * down2 - down_rise * both);
        const std::int64_t down = slope(down_rise * across2 - across_rise * both);
        const std::int64_t centre = mean_rise - (across * mean_x + down * mean_y) / 256;
        return {static_cast<std::int32_t>(centre), static_cast<std::int32_t>(across), static_cast<std::int32_t>(down)};
    }
};

} // namespace dicot::matching
