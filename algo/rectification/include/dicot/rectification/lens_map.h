// Where a pixel of a rectified picture comes from, in doubles: what the fixed-point table must agree with.
#pragma once

#include "dicot/rectification/rectify.h"

#include <optional>

namespace dicot {

/// A position in px, or a direction (x / z, y / z).
struct Position
{
    double x = 0;
    double y = 0;
};

/// Pixels of a rectified picture -> positions in the camera's picture. Only + - * / sqrt.
class LensMap
{
public:
    LensMap(const CameraModel& camera, const Matrix3& rectifying, double focal_px, double cx_px, double cy_px);

    /// Beyond the radius at which the lens model folds back, positions go on outwards: what the camera cannot see never
    /// comes from inside its picture.
    Position source_of(double x, double y) const;

private:
    CameraModel camera_;
    Matrix3 camera_from_rectified_;
    double focal_px_;
    double cx_px_;
    double cy_px_;
    double fold_radius_;
};

/// The direction, in the camera's frame, that a pixel was seen from; nothing where the distortion cannot be undone to
/// 1e-9 px.
std::optional<Position> direction_of(const CameraModel& camera, Position pixel);

} // namespace dicot
