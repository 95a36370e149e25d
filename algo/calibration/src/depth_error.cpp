#include "pinhole.h"

#include "dicot/calibration/camera.h"
#include "dicot/calibration/quality.h"

#include <cmath>

namespace dicot::calibration {

namespace {

constexpr int kGridCols = 9;
constexpr int kGridRows = 7;

/// The rig with one of its kRigNumbers numbers changed by a little.
StereoRig nudged(StereoRig rig, int number, double by)
{
    constexpr int kLensNumbers = 9;
    if (number < 2 * kLensNumbers) {
        Lens& lens = number < kLensNumbers ? rig.left : rig.right;
        LensVector v = lens_vector(lens);
        v[number % kLensNumbers] += by;
        lens = lens_of(v);
        return rig;
    }
    Eigen::Matrix<double, 6, 1> step = Eigen::Matrix<double, 6, 1>::Zero();
    step[number - 2 * kLensNumbers] = by;
    Pose pose{quaternion_of(rig.turn), {rig.shift_mm.x, rig.shift_mm.y, rig.shift_mm.z}};
    pose = pose.moved(step);
    rig.turn = turn_of(pose.turn);
    rig.shift_mm = {pose.shift.x(), pose.shift.y(), pose.shift.z()};
    return rig;
}

std::optional<double> depth_of(const StereoRig& rig, Point2 left, Point2 right)
{
    const std::optional<Point2> l = undistort(rig.left, left);
    const std::optional<Point2> r = undistort(rig.right, right);
    if (!l || !r)
        return std::nullopt;
    const std::optional<Point3> at = triangulate(rig, *l, *r);
    return at ? std::optional(at->z) : std::nullopt;
}

} // namespace

DepthError predict_depth_error(const StereoCalibration& calibration, double distance_mm)
{
    const StereoRig& rig = calibration.rig;
    DepthError error{distance_mm, 0, 0};
    double corner_squares = 0;
    int points = 0;
    for (int row = 0; row < kGridRows; ++row)
        for (int col = 0; col < kGridCols; ++col) {
            const Point2 left{(col + 0.5) / kGridCols * rig.width - 0.5, (row + 0.5) / kGridRows * rig.height - 0.5};
            const std::optional<Point2> direction = undistort(rig.left, left);
            if (!direction)
                continue;
            const Point3 in_right =
                rig.into_right({direction->x * distance_mm, direction->y * distance_mm, distance_mm});
            if (!(in_right.z > 0))
                continue;
            const Point2 right = project(rig.right, in_right);
            if (!(right.x > 0 && right.y > 0 && right.x < rig.width - 1 && right.y < rig.height - 1))
                continue;

            Eigen::Matrix<double, kRigNumbers, 1> slope = Eigen::Matrix<double, kRigNumbers, 1>::Zero();
            bool measurable = true;
            for (int k = 0; k < kRigNumbers; ++k) {
                const double step = calibration.deviation(k);
                if (step == 0)
                    continue;
                const std::optional<double> up = depth_of(nudged(rig, k, 0.05 * step), left, right);
                const std::optional<double> down = depth_of(nudged(rig, k, -0.05 * step), left, right);
                measurable = measurable && up && down;
                if (measurable)
                    slope[k] = (*up - *down) / (0.1 * step);
            }
            constexpr double kPixelStep = 0.01;
            const std::optional<double> far = depth_of(rig, left, {right.x + kPixelStep, right.y});
            const std::optional<double> near = depth_of(rig, left, {right.x - kPixelStep, right.y});
            if (!measurable || !far || !near)
                continue;
            const double by_px = (*far - *near) / (2 * kPixelStep);
            corner_squares += 2 * by_px * by_px * calibration.sigma_px * calibration.sigma_px;
            const Eigen::Map<const Eigen::Matrix<double, kRigNumbers, kRigNumbers, Eigen::RowMajor>> covariance(
                calibration.covariance.data());
            error.calibration_mm += slope.dot(covariance * slope);
            ++points;
        }
    if (points == 0)
        return error;
    error.corner_mm = std::sqrt((error.calibration_mm + corner_squares) / points);
    error.calibration_mm = std::sqrt(error.calibration_mm / points);
    return error;
}

} // namespace dicot::calibration
