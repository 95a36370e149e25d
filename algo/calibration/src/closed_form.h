// Starting values without a guess.
#pragma once

#include "pinhole.h"

#include "dicot/calibration/board.h"

#include <span>
#include <vector>

namespace dicot::calibration {

/// The 3 x 3 map from the plane of the board (mm, origin in its middle) to pixels; normalised DLT.
Eigen::Matrix3d board_homography(const Board& board, std::span<const Point2> corners);

/// A lens without distortion from differently tilted boards (Zhang 2000, section 3.1, no skew). Where the closed form
/// gives no plausible camera: the focal lengths alone, the centre taken as the picture's middle; in the end a common
/// webcam's.
LensVector lens_from_homographies(std::span<const Eigen::Matrix3d> homographies, int width, int height);

/// Where a board lies before a camera without distortion (Zhang 2000, section 3.1).
Pose pose_from_homography(const LensVector& lens, const Eigen::Matrix3d& homography);

/// The turn that is nearest to all in the sense of the chordal distance (Hartley et al. 2013).
Eigen::Quaterniond mean_turn(std::span<const Eigen::Quaterniond> turns);

} // namespace dicot::calibration
