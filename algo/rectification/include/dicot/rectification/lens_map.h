// Where a pixel of a rectified picture comes from, in doubles: what the fixed-point table must agree with.
#pragma once

#include "dicot/base/stereo_rig.h"

namespace dicot {

/// Pixels of a rectified picture -> positions in the camera's picture. Only + - * / sqrt.
class LensMap
{
public:
    LensMap(const Lens& lens, const Turn& rectifying, double focal_px, double cx_px, double cy_px);

    /// Beyond the radius at which the lens model folds back, positions go on outwards: what the camera cannot see never
    /// comes from inside its picture.
    Point2 source_of(double x, double y) const;

private:
    Lens lens_;
    Turn camera_from_rectified_;
    double focal_px_;
    double cx_px_;
    double cy_px_;
    double fold_radius_;
};

} // namespace dicot
