// Least squares over both lenses, the rig and all board poses at once.
#pragma once

#include "pinhole.h"

#include "dicot/calibration/board.h"

#include <array>
#include <span>
#include <vector>

namespace dicot::calibration {

/// Layout of the numbers that all views share.
constexpr int kLeftLens = 0;
constexpr int kRightLens = 9;
constexpr int kRigPose = 18; // rotation vector, then shift
constexpr int kWarp = 24;
constexpr int kShared = 26;
using SharedVector = Eigen::Matrix<double, kShared, 1>;
using SharedMatrix = Eigen::Matrix<double, kShared, kShared>;
using PoseVector = Eigen::Matrix<double, 6, 1>;

struct BundleView
{
    const Board* board = nullptr;
    std::span<const Point2> left; // empty: not seen
    std::span<const Point2> right;
    Pose pose; // board to left camera
    bool used = true;
};

/// The last one forgets what is far off (Geman and McClure 1985); it needs a good start.
enum class Loss
{
    kSquare,
    kHuber,
    kGemanMcClure
};

struct Bundle
{
    std::array<LensVector, 2> lens;
    Pose rig; // left camera to right camera
    Eigen::Vector2d warp = Eigen::Vector2d::Zero();
    std::vector<BundleView> views;
    std::array<bool, kShared> fitted{};
    Loss loss = Loss::kSquare;
    double loss_scale_px = 1;
};

/// The corner (col, row) in the board's frame: origin in the middle, z away from the viewer, bowed by `warp` mm.
Eigen::Vector3d board_point(const Board& board, const Eigen::Vector2d& warp, int col, int row);

/// One corner's residual (predicted minus seen) and its derivatives.
struct Term
{
    Eigen::Vector2d residual;
    Eigen::Matrix<double, 2, kShared> by_shared;
    Eigen::Matrix<double, 2, 6> by_pose;
    bool in_front;
};
Term corner_term(const Bundle& bundle, const BundleView& view, bool in_right, int col, int row, Point2 seen);

struct BundleReport
{
    double cost = 0; // sum of the loss over the corners, px^2
    int iterations = 0;
    bool settled = false;
};

/// Levenberg-Marquardt; the board poses are eliminated (Schur complement) and put back.
BundleReport minimise(Bundle& bundle, int max_iterations);

/// Inverse of the curvature in the shared numbers, poses eliminated; zero rows for numbers that are not fitted. Times
/// the variance of a coordinate it is the covariance. Not finite when the views do not determine the numbers.
SharedMatrix inverse_curvature(const Bundle& bundle);

/// Predicted minus seen for every corner of one side of a view.
std::vector<Eigen::Vector2d> residuals(const Bundle& bundle, const BundleView& view, bool in_right);

} // namespace dicot::calibration
