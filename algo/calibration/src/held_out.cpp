#include "held_out.h"

#include "bundle.h"

#include "dicot/calibration/camera.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>
#include <memory>

namespace dicot::calibration {

std::optional<BoardFit> measure_board(const StereoRig& rig, const Board& board, std::span<const double, 2> warp_mm,
                                      const View& view)
{
    std::vector<Eigen::Vector3d> truth, measured;
    for (int row = 0; row < board.rows; ++row)
        for (int col = 0; col < board.cols; ++col) {
            const auto k = static_cast<std::size_t>(row * board.cols + col);
            const std::optional<Point2> l = undistort(rig.left, view.left[k]);
            const std::optional<Point2> r = undistort(rig.right, view.right[k]);
            const std::optional<Point3> p = l && r ? triangulate(rig, *l, *r) : std::nullopt;
            if (!p)
                return std::nullopt;
            measured.emplace_back(p->x, p->y, p->z);
            truth.push_back(board_point(board, {warp_mm[0], warp_mm[1]}, col, row));
        }

    // Umeyama 1991; the scale is reported, and left out of the residual.
    const double count = static_cast<double>(truth.size());
    Eigen::Vector3d truth_mean = Eigen::Vector3d::Zero();
    Eigen::Vector3d measured_mean = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < truth.size(); ++k) {
        truth_mean += truth[k] / count;
        measured_mean += measured[k] / count;
    }
    Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();
    double spread = 0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
        mixed += (measured[k] - measured_mean) * (truth[k] - truth_mean).transpose();
        spread += (truth[k] - truth_mean).squaredNorm();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(mixed, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d sign(1, 1, 1);
    if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0)
        sign[2] = -1;
    const Eigen::Matrix3d turn = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();

    BoardFit fit;
    fit.scale = (turn.transpose() * mixed).trace() / spread;
    fit.distance_mm = measured_mean.norm();
    for (std::size_t k = 0; k < truth.size(); ++k)
        fit.shape_mm += ((measured[k] - measured_mean) - turn * (truth[k] - truth_mean)).squaredNorm() / count;
    fit.shape_mm = std::sqrt(fit.shape_mm);
    return fit;
}

HeldOut cross_validate(const CalibrationTask& task, const StereoCalibration& calibration, int folds)
{
    std::vector<std::size_t> pairs;
    for (std::size_t v = 0; v < task.views.size(); ++v)
        if (calibration.views[v].used && !task.views[v].left.empty() && !task.views[v].right.empty())
            pairs.push_back(v);

    HeldOut sum;
    const std::unique_ptr<bool[]> chosen(new bool[task.views.size()]);
    const auto all = static_cast<std::size_t>(folds);
    for (std::size_t fold = 0; fold < all && fold < pairs.size(); ++fold) {
        std::fill_n(chosen.get(), task.views.size(), true);
        for (std::size_t k = fold; k < pairs.size(); k += all)
            chosen[pairs[k]] = false;
        const StereoCalibration without = solve_again(task, calibration, {chosen.get(), task.views.size()});
        for (std::size_t k = fold; k < pairs.size(); k += all) {
            const View& view = task.views[pairs[k]];
            const Board& board = task.boards[static_cast<std::size_t>(view.board)];
            const std::optional<BoardFit> fit = measure_board(without.rig, board, without.warp_mm, view);
            if (!fit)
                continue;
            sum.shape_mm += fit->shape_mm * fit->shape_mm;
            sum.size_percent += 1e4 * (fit->scale - 1) * (fit->scale - 1);
            const double depth_mm = (fit->scale - 1) * fit->distance_mm;
            sum.depth_mm += depth_mm * depth_mm;
            ++sum.pairs;
        }
    }
    if (sum.pairs > 0)
        for (double* value : {&sum.shape_mm, &sum.depth_mm, &sum.size_percent})
            *value = std::sqrt(*value / sum.pairs);
    return sum;
}

} // namespace dicot::calibration
