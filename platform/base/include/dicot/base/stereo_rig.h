// Two cameras that look at the same scene, in OpenCV's conventions.
#pragma once

#include <array>
#include <optional>

namespace dicot {

/// A position in a picture, in px; (0, 0) is the centre of the top-left pixel. Also a direction (x / z, y / z).
struct Point2
{
    double x = 0;
    double y = 0;
};

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

/// A pinhole with Brown-Conrady distortion (Brown 1971): focal lengths and centre in px, k in the order k1 k2 p1 p2 k3.
struct Lens
{
    double fx = 0;
    double fy = 0;
    double cx = 0;
    double cy = 0;
    std::array<double, 5> k{};
};

/// A point in front of a camera (z > 0) as a pixel.
Point2 project(const Lens& lens, const Point3& point) noexcept;

/// The direction from which a pixel was seen; nothing where the distortion cannot be undone.
std::optional<Point2> undistort(const Lens& lens, Point2 pixel) noexcept;

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
