// What a calibration makes of pairs that it has not seen.
#pragma once

#include "dicot/calibration/solve.h"

namespace dicot::calibration {

struct HeldOut
{
    double shape_mm = 0;
    double depth_mm = 0;
    double size_percent = 0;
    int pairs = 0;
};

/// Solves `folds` times without every folds-th pair and triangulates what was left out.
HeldOut cross_validate(const CalibrationTask& task, const StereoCalibration& calibration, int folds);

/// A triangulated board against the true one.
struct BoardFit
{
    double shape_mm = 0;    ///< RMS distance of the corners after the best rigid motion
    double scale = 1;       ///< triangulated over true size
    double distance_mm = 0; ///< of the board's middle from the left camera
};
std::optional<BoardFit> measure_board(const StereoRig& rig, const Board& board, std::span<const double, 2> warp_mm,
                                      const View& view);

} // namespace dicot::calibration
