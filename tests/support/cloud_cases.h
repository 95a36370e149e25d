// Rigs and clouds that several tests use.
#pragma once

#include "dicot/base/cloud.h"

#include <cstdint>
#include <random>
#include <vector>

namespace dicot::test {

/// The Aloe pair of Middlebury 2006 at a third of its size: 3740 px and 160 mm at full size, where the crop's disparity
/// offset is 270 px as far as is known.
inline RigGeometry aloe_third()
{
    return {427, 370, 3740.0 / 3, 213.0, 184.5, 270.0 / 3, 160.0};
}

/// `count` points anywhere on the grid, any colour, any confidence: what compresses worst.
inline std::vector<CloudPoint> random_points(const CloudGrid& grid, std::size_t count, std::uint32_t seed)
{
    std::mt19937 random{seed};
    const std::uint32_t mask = (1U << grid.bits) - 1;
    std::vector<CloudPoint> points(count);
    const auto on_axis = [&](int axis) { return grid.origin[axis] + static_cast<std::int32_t>(random() & mask); };
    for (CloudPoint& point : points) {
        point.x = on_axis(0);
        point.y = on_axis(1);
        point.z = on_axis(2);
        const std::uint32_t bits = static_cast<std::uint32_t>(random());
        point.colour = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
                        static_cast<std::uint8_t>(bits >> 16)};
        point.confidence = static_cast<std::uint8_t>(bits >> 24);
    }
    return points;
}

} // namespace dicot::test
