// The rectifying rotations and the common camera of a stereo pair.
#pragma once

#include "dicot/base/status.h"
#include "dicot/base/stereo_rig.h"

namespace dicot {

/// Both rectified cameras: the same focal length and principal point (so disparity 0 is infinitely far), rows parallel
/// to the baseline, pictures of the source's size. In OpenCV's words: R1 = left_rectifying, R2 = right_rectifying, P1 =
/// [f 0 cx 0; 0 f cy 0; 0 0 1 0], P2 the same with P2(0,3) = -f * baseline_mm.
struct Rectification
{
    int width = 0;
    int height = 0;
    Turn left_rectifying{}; ///< rectified from camera
    Turn right_rectifying{};
    double focal_px = 0;
    double cx_px = 0;
    double cy_px = 0;
    double baseline_mm = 0;
};

/// How much of the source pictures stays: 0 crops until every pixel of both rectified pictures has a source, 1 keeps
/// every source pixel; between them the focal length is between. OpenCV's `alpha`.
inline constexpr double kCrop = 0.0;
inline constexpr double kKeepAll = 1.0;

/// Bouguet's rectification: each camera turns half of the rotation between them, then both turn so that the baseline is
/// horizontal (as OpenCV's stereoRectify with CALIB_ZERO_DISPARITY, without its trigonometry). Only + - * / sqrt, so
/// the result has the same bits on every CPU. `name` stands for the rig in sentences. Fault::kBadData: not finite, no
/// rotation, no focal length, cameras above each other, swapped or at one place, distortion that cannot be undone
/// within the picture.
Result<Rectification> rectify(const StereoRig& rig, double keep, const char* name);

} // namespace dicot
