// Cameras and the rig of two, in OpenCV's conventions.
#pragma once

#include "dicot/calibration/board.h"

#include <array>
#include <optional>

namespace dicot::calibration {

struct Point3
{
    double x = 0;
    double y = 0;
    double z = 0;
};

/// A turn as a 3 x 3 matrix, row after row.
using Turn = std::array<double, 9>;

/// A pinhole with Brown-Conrady distortion (Brown 1971): focal lengths and centre in px, k in the order k1 k2 p1 p2 k3.
struct Lens
{
    double fx = 0;
    double fy = 0;
    double cx = 0;
    double cy = 0;
    std::array<double, 5> k{};
};

/// A point in front of a camera (z > 0), in the camera's frame (x right, y down, z forward), as a pixel.
Point2 project(const Lens& lens, const Point3& point);

/// The direction (x / z, y / z) from which a pixel was seen; nothing where the distortion cannot be undone.
std::optional<Point2> undistort(const Lens& lens, Point2 pixel);

/// Two cameras: x_right = turn x_left + shift_mm. The right camera of a usable rig stands to the right: shift.x < 0.
struct StereoRig
{
    int width = 0;
    int height = 0;
    Lens left;
    Lens right;
    Turn turn{1, 0, 0, 0, 1, 0, 0, 0, 1};
    Point3 shift_mm;

    double baseline_mm() const;
    Point3 into_right(const Point3& in_left) const;
};

/// Where the two directions meet, in the left camera's frame: the middle of their shortest connection; nothing when they
/// are parallel.
std::optional<Point3> triangulate(const StereoRig& rig, Point2 left_direction, Point2 right_direction);

/// The distance in px between a corner and the epipolar line of its partner, taken half each in both pictures after
/// distortion is removed; nothing where the distortion cannot be undone.
std::optional<double> epipolar_distance_px(const StereoRig& rig, Point2 left, Point2 right);

} // namespace dicot::calibration
