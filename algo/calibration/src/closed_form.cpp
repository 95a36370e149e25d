#include "closed_form.h"

#include "bundle.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace dicot::calibration {

namespace {

/// Moves points to mean 0 and mean square distance 2.
Eigen::Matrix3d normalising(const std::vector<Eigen::Vector2d>& points)
{
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : points)
        mean += p / static_cast<double>(points.size());
    double spread = 0;
    for (const Eigen::Vector2d& p : points)
        spread += (p - mean).squaredNorm() / static_cast<double>(points.size());
    const double scale = std::sqrt(2.0 / std::max(spread, 1e-12));
    Eigen::Matrix3d m;
    m << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
    return m;
}

/// Zhang's v_ij for a camera without skew: (h_i^T B h_j) as a product with (B11, B22, B13, B23, B33).
Eigen::Matrix<double, 1, 5> constraint(const Eigen::Vector3d& p, const Eigen::Vector3d& q)
{
    return {p[0] * q[0], p[1] * q[1], p[2] * q[0] + p[0] * q[2], p[2] * q[1] + p[1] * q[2], p[2] * q[2]};
}

bool plausible(const LensVector& lens, int width, int height)
{
    const double size = std::max(width, height);
    const auto focal = [&](double f) { return f > 0.2 * size && f < 20 * size; };
    return focal(lens[0]) && focal(lens[1]) && lens[0] < 2 * lens[1] && lens[1] < 2 * lens[0] &&
           std::abs(lens[2] - 0.5 * width) < 0.3 * width && std::abs(lens[3] - 0.5 * height) < 0.3 * height;
}

std::optional<LensVector> with_centre(std::span<const Eigen::Matrix3d> homographies, int width, int height)
{
    // In units of the picture's size around its middle, so that the five unknowns have like sizes.
    const double size = std::max(width, height);
    Eigen::Matrix3d units;
    units << 1 / size, 0, -0.5 * (width - 1) / size, 0, 1 / size, -0.5 * (height - 1) / size, 0, 0, 1;
    Eigen::Matrix<double, 5, 5> gram = Eigen::Matrix<double, 5, 5>::Zero();
    for (const Eigen::Matrix3d& homography : homographies) {
        Eigen::Matrix3d h = units * homography;
        h /= h.leftCols<2>().norm();
        const Eigen::Matrix<double, 1, 5> orthogonal = constraint(h.col(0), h.col(1));
        const Eigen::Matrix<double, 1, 5> alike = constraint(h.col(0), h.col(0)) - constraint(h.col(1), h.col(1));
        gram += orthogonal.transpose() * orthogonal + alike.transpose() * alike;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 5, 5>> eigen(gram);
    const Eigen::Matrix<double, 5, 1> b = eigen.eigenvectors().col(0);
    const double cx = -b[2] / b[0];
    const double cy = -b[3] / b[1];
    const double scale = b[4] - b[2] * b[2] / b[0] - b[3] * b[3] / b[1];
    const double fx2 = scale / b[0];
    const double fy2 = scale / b[1];
    if (!(fx2 > 0 && fy2 > 0))
        return std::nullopt;
    LensVector lens = LensVector::Zero();
    lens.head<4>() << size * std::sqrt(fx2), size * std::sqrt(fy2), size * cx + 0.5 * (width - 1),
        size * cy + 0.5 * (height - 1);
    return lens;
}

LensVector centre_given(std::span<const Eigen::Matrix3d> homographies, int width, int height)
{
    const double size = std::max(width, height);
    Eigen::Matrix3d units;
    units << 1 / size, 0, -0.5 * (width - 1) / size, 0, 1 / size, -0.5 * (height - 1) / size, 0, 0, 1;
    Eigen::Matrix2d gram = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (const Eigen::Matrix3d& homography : homographies) {
        Eigen::Matrix3d h = units * homography;
        h /= h.leftCols<2>().norm();
        const auto add = [&](double x, double y, double z) {
            const Eigen::Vector2d row(x, y);
            gram += row * row.transpose();
            right -= z * row;
        };
        add(h(0, 0) * h(0, 1), h(1, 0) * h(1, 1), h(2, 0) * h(2, 1));
        add(h(0, 0) * h(0, 0) - h(0, 1) * h(0, 1), h(1, 0) * h(1, 0) - h(1, 1) * h(1, 1),
            h(2, 0) * h(2, 0) - h(2, 1) * h(2, 1));
    }
    LensVector lens = LensVector::Zero();
    lens.head<4>() << 0, 0, 0.5 * (width - 1), 0.5 * (height - 1);
    const Eigen::Vector2d inverse_squares = gram.ldlt().solve(right);
    if (inverse_squares.minCoeff() > 0)
        lens.head<2>() = size * inverse_squares.cwiseInverse().cwiseSqrt();
    if (plausible(lens, width, height))
        return lens;
    lens[0] = lens[1] = size * std::sqrt(std::max(gram.sum() / right.sum(), 0.0)); // one focal length for both
    if (plausible(lens, width, height))
        return lens;
    lens[0] = lens[1] = size; // a common webcam's; the refinement finds out whether the views can tell
    return lens;
}

} // namespace

Eigen::Matrix3d board_homography(const Board& board, std::span<const Point2> corners)
{
    std::vector<Eigen::Vector2d> from, to;
    for (int row = 0; row < board.rows; ++row)
        for (int col = 0; col < board.cols; ++col) {
            from.emplace_back(board_point(board, Eigen::Vector2d::Zero(), col, row).head<2>());
            const Point2 seen = corners[static_cast<std::size_t>(row * board.cols + col)];
            to.emplace_back(seen.x, seen.y);
        }
    const Eigen::Matrix3d from_unit = normalising(from);
    const Eigen::Matrix3d to_unit = normalising(to);
    Eigen::Matrix<double, 9, 9> gram = Eigen::Matrix<double, 9, 9>::Zero();
    for (std::size_t k = 0; k < from.size(); ++k) {
        const Eigen::Vector3d p = from_unit * from[k].homogeneous();
        const Eigen::Vector3d q = to_unit * to[k].homogeneous();
        Eigen::Matrix<double, 2, 9> rows;
        rows << p.transpose(), Eigen::RowVector3d::Zero(), -q.x() * p.transpose(), //
            Eigen::RowVector3d::Zero(), p.transpose(), -q.y() * p.transpose();
        gram += rows.transpose() * rows;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(gram);
    const Eigen::Matrix<double, 9, 1> h = eigen.eigenvectors().col(0);
    Eigen::Matrix3d unit;
    unit << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8];
    const Eigen::Matrix3d homography = to_unit.inverse() * unit * from_unit;
    return homography / homography(2, 2);
}

LensVector lens_from_homographies(std::span<const Eigen::Matrix3d> homographies, int width, int height)
{
    if (homographies.size() >= 3) {
        const std::optional<LensVector> lens = with_centre(homographies, width, height);
        if (lens && plausible(*lens, width, height))
            return *lens;
    }
    return centre_given(homographies, width, height);
}

Pose pose_from_homography(const LensVector& lens, const Eigen::Matrix3d& homography)
{
    Eigen::Matrix3d k;
    k << lens[0], 0, lens[2], 0, lens[1], lens[3], 0, 0, 1;
    Eigen::Matrix3d m = k.inverse() * homography;
    m *= 2 / (m.col(0).norm() + m.col(1).norm());
    if (m(2, 2) < 0)
        m = -m;
    Pose pose;
    pose.shift = m.col(2);
    m.col(2) = m.col(0).cross(m.col(1));
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d turn = svd.matrixU() * svd.matrixV().transpose();
    if (turn.determinant() < 0)
        turn = svd.matrixU() * Eigen::Vector3d(1, 1, -1).asDiagonal() * svd.matrixV().transpose();
    pose.turn = Eigen::Quaterniond(turn).normalized();
    return pose;
}

Eigen::Quaterniond mean_turn(std::span<const Eigen::Quaterniond> turns)
{
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    for (const Eigen::Quaterniond& q : turns)
        sum += q.coeffs() * q.coeffs().transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(sum);
    const Eigen::Vector4d mean = eigen.eigenvectors().col(3);
    return Eigen::Quaterniond(mean[3], mean[0], mean[1], mean[2]).normalized();
}

} // namespace dicot::calibration
