// A camera's lens, in OpenCV's conventions.
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

/// A pinhole with OpenCV's distortion: focal lengths and centre in px, k in the order k1 k2 p1 p2 k3 (Brown 1971) k4 k5
/// k6 (the rational model) s1 s2 s3 s4 (a thin prism); unknown ones are 0.
struct Lens
{
    double fx = 0;
    double fy = 0;
    double cx = 0;
    double cy = 0;
    std::array<double, 12> k{};
};

/// By how much the lens stretches a direction whose squared distance from the axis is r2, without tangential and prism
/// parts.
double radial_scale(const Lens& lens, double r2) noexcept;

/// Where a direction seems to come from behind the lens. Only + - * /, as all of this header.
Point2 distort(const Lens& lens, Point2 direction) noexcept;

/// A direction as a pixel.
Point2 pixel_of(const Lens& lens, Point2 direction) noexcept;

/// The direction from which a pixel was seen, to 1e-13; nothing where the distortion cannot be undone.
std::optional<Point2> undistort(const Lens& lens, Point2 pixel) noexcept;

} // namespace dicot
