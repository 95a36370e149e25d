// What two calibrated cameras see together.
#pragma once

#include "dicot/base/stereo_rig.h"

#include <optional>

namespace dicot::calibration {

/// Where the two directions meet, in the left camera's frame: the middle of their shortest connection; nothing when
/// they are parallel.
std::optional<Point3> triangulate(const StereoRig& rig, Point2 left_direction, Point2 right_direction);

/// The distance in px between a corner and the epipolar line of its partner, taken half each in both pictures after
/// distortion is removed; nothing where the distortion cannot be undone.
std::optional<double> epipolar_distance_px(const StereoRig& rig, Point2 left, Point2 right);

} // namespace dicot::calibration
