// OpenCV's way from a picture to corners and from corners to a rig, beside ours.
#pragma once

#include "calibration_data.h"

#include "dicot/calibration/solve.h"

#include <vector>

namespace dicot::test {

enum class OpenCvEyes
{
    kPlain,  ///< findChessboardCorners, then cornerSubPix in a window of 11 x 11 px
    kSectors ///< findChessboardCornersSB
};

/// All corners of the board, row after row, or none.
std::vector<Point2> corners_by_opencv(OpenCvEyes eyes, GreyPicture& picture, const Board& board);

struct Solved
{
    StereoRig rig;
    double rms_px = 0; ///< over the corners of both cameras
};

/// calibrateCamera for each camera, then stereoCalibrate with everything free but k3 = 0.
Solved solved_by_opencv(const CalibrationTask& task);

} // namespace dicot::test
