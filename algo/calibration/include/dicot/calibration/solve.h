// From corners to the geometry of the rig.
#pragma once

#include "dicot/calibration/board.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace dicot::calibration {

/// One pose of a board as the two cameras saw it. A camera that did not see it has no corners; such a view helps the
/// other camera's lens.
struct View
{
    int board = 0; ///< index into the boards of the task
    std::vector<Point2> left;
    std::vector<Point2> right;
};

struct CalibrationTask
{
    std::vector<Board> boards;
    std::vector<View> views;
    int width = 0;
    int height = 0;
    bool fit_k3 = false;   ///< else k3 = 0
    bool fit_warp = false; ///< two numbers for a board that is bowed along its columns and rows
};

/// What became of one view, in the order of the task.
struct ViewOutcome
{
    bool used = false;
    std::string reason; ///< why it was dropped
    Turn turn{};        ///< x_left = turn x_board + shift_mm; the board's origin is its middle
    Point3 shift_mm;
    double rms_left_px = 0;
    double rms_right_px = 0;
};

/// The order of the numbers in a covariance: fx fy cx cy k1 k2 p1 p2 k3 of the left lens, of the right lens, then the
/// right-hand turn's rotation vector (radians, applied after `turn`), then shift_mm.
constexpr int kRigNumbers = 24;

struct StereoCalibration
{
    StereoRig rig;
    std::vector<ViewOutcome> views;
    int pairs_used = 0;
    double rms_left_px = 0; ///< root of the mean squared distance between seen and predicted corners
    double rms_right_px = 0;
    double rms_px = 0;               ///< over both
    double sigma_px = 0;             ///< estimated standard deviation of a corner's coordinate
    std::array<double, 2> warp_mm{}; ///< depth of the bow along columns and rows
    /// Row after row. Rows of numbers that were not fitted are zero.
    std::array<double, kRigNumbers * kRigNumbers> covariance{};

    double deviation(int number) const;
};

/// Fits both lenses and the rig to all views.
///
/// Zhang's closed form for each camera (Zhang 2000), Levenberg-Marquardt over everything at once with a robust loss;
/// views that do not fit are dropped and named. kBadData, with advice, for sets that cannot give a calibration: fewer
/// than kMinPairs pairs, all views alike, one camera only, left and right swapped, corners outside the pictures.
Result<StereoCalibration> solve_stereo(const CalibrationTask& task);

constexpr int kMinPairs = 4;

/// Where a camera should see the corners of a view, px, row after row, the board's bow included; not a number where a
/// corner would lie behind the camera.
std::vector<Point2> predicted_corners(const CalibrationTask& task, const StereoCalibration& calibration,
                                      std::size_t view, bool in_right);

/// As solve_stereo, from a former result and over the views marked `chosen` only; nothing is dropped or refused.
StereoCalibration solve_again(const CalibrationTask& task, const StereoCalibration& start,
                              std::span<const bool> chosen);

} // namespace dicot::calibration
