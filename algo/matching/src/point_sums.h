// Weighted sums of positions and of what stands there, for planes of least squares.
#pragma once

#include <cstdint>

namespace dicot::matching {

/// Points (dx, dy, rise) around a centre. Who adds knows the bounds.
struct PointSums
{
    std::int64_t one = 0, x = 0, y = 0, rise = 0, xx = 0, xy = 0, yy = 0, x_rise = 0, y_rise = 0;

    void add(std::int64_t weight, int dx, int dy, std::int64_t rise_here)
    {
        one += weight;
        x += weight * dx;
        y += weight * dy;
        rise += weight * rise_here;
        xx += weight * (dx * dx);
        xy += weight * (dx * dy);
        yy += weight * (dy * dy);
        x_rise += weight * dx * rise_here;
        y_rise += weight * dy * rise_here;
    }
};

} // namespace dicot::matching
