// Two cameras that look at the same scene, in OpenCV's conventions.
#pragma once

#include "dicot/base/lens.h"

#include <array>

namespace dicot {

/// A position in the frame of a camera: x right, y down, z forward.
struct Point3
{
    double x = 0;
    double y = 0;
    double z = 0;
};

/// A turn as a 3 x 3 matrix, row after row.
using Turn = std::array<double, 9>;

Point3 turned(const Turn& turn, const Point3& p) noexcept;
Turn transposed(const Turn& turn) noexcept;
/// First `b`, then `a`.
Turn product(const Turn& a, const Turn& b) noexcept;

/// A point in front of a camera (z > 0) as a pixel.
Point2 project(const Lens& lens, const Point3& point) noexcept;

/// Two cameras: x_right = turn x_left + shift_mm. The right camera of a usable rig stands to the right: shift_mm.x < 0.
struct StereoRig
{
    int width = 0; ///< px, of each picture
    int height = 0;
    Lens left;
    Lens right;
    Turn turn{1, 0, 0, 0, 1, 0, 0, 0, 1};
    Point3 shift_mm;

    double baseline_mm() const noexcept;
    Point3 into_right(const Point3& in_left) const noexcept;
};

} // namespace dicot
