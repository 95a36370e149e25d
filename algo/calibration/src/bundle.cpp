#include "bundle.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace dicot::calibration {

namespace {

constexpr double kBehind = 1e9; // px^2: the cost of a corner that a step puts behind its camera

struct PoseBlock
{
    Eigen::Matrix<double, 6, 6> curvature = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, kShared, 6> mixed = Eigen::Matrix<double, kShared, 6>::Zero();
    PoseVector slope = PoseVector::Zero();
};

struct Normals
{
    SharedMatrix curvature = SharedMatrix::Zero();
    SharedVector slope = SharedVector::Zero();
    std::vector<PoseBlock> poses;
    double cost = 0;
};

struct Weighed
{
    double cost;
    double weight;
};

Weighed weigh(Loss loss, double scale, double squared)
{
    const double s2 = scale * scale;
    switch (loss) {
    case Loss::kHuber: {
        if (squared <= s2)
            return {squared, 1};
        const double size = std::sqrt(squared);
        return {2 * scale * size - s2, scale / size};
    }
    case Loss::kGemanMcClure: {
        const double fall = 1 / (1 + squared / s2);
        return {squared * fall, fall * fall};
    }
    case Loss::kSquare:
        break;
    }
    return {squared, 1};
}

template <typename Visit>
void for_each_corner(const BundleView& view, Visit visit)
{
    for (const bool in_right : {false, true}) {
        const std::span<const Point2> seen = in_right ? view.right : view.left;
        if (seen.empty())
            continue;
        for (int row = 0; row < view.board->rows; ++row)
            for (int col = 0; col < view.board->cols; ++col)
                visit(in_right, col, row, seen[static_cast<std::size_t>(row * view.board->cols + col)]);
    }
}

Normals gather(const Bundle& bundle)
{
    Normals n;
    n.poses.resize(bundle.views.size());
    for (std::size_t v = 0; v < bundle.views.size(); ++v) {
        const BundleView& view = bundle.views[v];
        if (!view.used)
            continue;
        PoseBlock& pose = n.poses[v];
        for_each_corner(view, [&](bool in_right, int col, int row, Point2 seen) {
            const Term term = corner_term(bundle, view, in_right, col, row, seen);
            if (!term.in_front) {
                n.cost += kBehind;
                return;
            }
            const Weighed w = weigh(bundle.loss, bundle.loss_scale_px, term.residual.squaredNorm());
            n.cost += w.cost;
            n.curvature += w.weight * term.by_shared.transpose() * term.by_shared;
            n.slope += w.weight * term.by_shared.transpose() * term.residual;
            pose.curvature += w.weight * term.by_pose.transpose() * term.by_pose;
            pose.mixed += w.weight * term.by_shared.transpose() * term.by_pose;
            pose.slope += w.weight * term.by_pose.transpose() * term.residual;
        });
    }
    for (int k = 0; k < kShared; ++k)
        if (!bundle.fitted[static_cast<std::size_t>(k)]) {
            n.curvature.row(k).setZero();
            n.curvature.col(k).setZero();
            n.slope[k] = 0;
            for (PoseBlock& pose : n.poses)
                pose.mixed.row(k).setZero();
        }
    return n;
}

double cost_of(const Bundle& bundle)
{
    double cost = 0;
    for (const BundleView& view : bundle.views)
        if (view.used)
            for_each_corner(view, [&](bool in_right, int col, int row, Point2 seen) {
                Eigen::Vector3d at = view.pose * board_point(*view.board, bundle.warp, col, row);
                if (in_right)
                    at = bundle.rig * at;
                if (!(at.z() > 0)) {
                    cost += kBehind;
                    return;
                }
                const Point2 p = project(lens_of(bundle.lens[in_right ? 1 : 0]), {at.x(), at.y(), at.z()});
                const double squared = (p.x - seen.x) * (p.x - seen.x) + (p.y - seen.y) * (p.y - seen.y);
                cost += weigh(bundle.loss, bundle.loss_scale_px, squared).cost;
            });
    return cost;
}

/// Poses eliminated; numbers that are not fitted get an equation of their own.
SharedMatrix reduced(const Bundle& bundle, const Normals& n, double damping,
                     std::vector<Eigen::Matrix<double, 6, 6>>& inverse)
{
    SharedMatrix s = n.curvature;
    s.diagonal() *= 1 + damping;
    inverse.assign(n.poses.size(), Eigen::Matrix<double, 6, 6>::Zero());
    for (std::size_t v = 0; v < n.poses.size(); ++v) {
        if (!bundle.views[v].used)
            continue;
        Eigen::Matrix<double, 6, 6> curvature = n.poses[v].curvature;
        curvature.diagonal() *= 1 + damping;
        inverse[v] = curvature.ldlt().solve(Eigen::Matrix<double, 6, 6>::Identity());
        s -= n.poses[v].mixed * inverse[v] * n.poses[v].mixed.transpose();
    }
    for (int k = 0; k < kShared; ++k)
        if (!bundle.fitted[static_cast<std::size_t>(k)])
            s(k, k) = 1;
    return s;
}

void step_along(Bundle& bundle, const SharedVector& shared, const std::vector<PoseVector>& poses)
{
    bundle.lens[0] += shared.segment<9>(kLeftLens);
    bundle.lens[1] += shared.segment<9>(kRightLens);
    bundle.rig = bundle.rig.moved(shared.segment<6>(kRigPose));
    bundle.warp += shared.segment<2>(kWarp);
    for (std::size_t v = 0; v < poses.size(); ++v)
        if (bundle.views[v].used)
            bundle.views[v].pose = bundle.views[v].pose.moved(poses[v]);
}

} // namespace

Eigen::Vector3d board_point(const Board& board, const Eigen::Vector2d& warp, int col, int row)
{
    const double half_x = 0.5 * (board.cols - 1);
    const double half_y = 0.5 * (board.rows - 1);
    const double u = (col - half_x) / half_x;
    const double v = (row - half_y) / half_y;
    return {board.square_mm * (col - half_x), board.square_mm * (row - half_y),
            warp[0] * (1 - u * u) + warp[1] * (1 - v * v)};
}

Term corner_term(const Bundle& bundle, const BundleView& view, bool in_right, int col, int row, Point2 seen)
{
    const Eigen::Vector3d on_board = board_point(*view.board, bundle.warp, col, row);
    const Eigen::Vector3d turned = view.pose.turn * on_board;
    const Eigen::Vector3d in_left = turned + view.pose.shift;
    const Eigen::Matrix3d rig_turn = bundle.rig.turn.toRotationMatrix();
    const Eigen::Vector3d rig_turned = rig_turn * in_left;
    const Eigen::Vector3d at = in_right ? Eigen::Vector3d(rig_turned + bundle.rig.shift) : in_left;

    Term term;
    term.by_shared.setZero();
    term.by_pose.setZero();
    term.in_front = at.z() > 0;
    if (!term.in_front)
        return term;
    const Projection p = project_with_derivatives(bundle.lens[in_right ? 1 : 0], at);
    term.residual = p.pixel - Eigen::Vector2d(seen.x, seen.y);
    term.by_shared.middleCols<9>(in_right ? kRightLens : kLeftLens) = p.by_lens;
    Eigen::Matrix<double, 2, 3> by_left = p.by_point;
    if (in_right) {
        term.by_shared.middleCols<3>(kRigPose) = -p.by_point * skew(rig_turned);
        term.by_shared.middleCols<3>(kRigPose + 3) = p.by_point;
        by_left = p.by_point * rig_turn;
    }
    term.by_pose.leftCols<3>() = -by_left * skew(turned);
    term.by_pose.rightCols<3>() = by_left;

    const double half_x = 0.5 * (view.board->cols - 1);
    const double half_y = 0.5 * (view.board->rows - 1);
    const double u = (col - half_x) / half_x;
    const double v = (row - half_y) / half_y;
    const Eigen::Vector2d by_depth = by_left * view.pose.turn.toRotationMatrix().col(2);
    term.by_shared.col(kWarp) = (1 - u * u) * by_depth;
    term.by_shared.col(kWarp + 1) = (1 - v * v) * by_depth;
    return term;
}

BundleReport minimise(Bundle& bundle, int max_iterations)
{
    constexpr double kLeastDamping = 1e-12;
    constexpr double kMostDamping = 1e10;
    constexpr double kSettled = 1e-10; // relative fall of the cost
    double damping = 1e-3;
    Normals n = gather(bundle);
    BundleReport report{n.cost, 0, false};
    std::vector<Eigen::Matrix<double, 6, 6>> inverse;
    std::vector<PoseVector> pose_steps(bundle.views.size(), PoseVector::Zero());

    while (report.iterations < max_iterations && !report.settled) {
        ++report.iterations;
        bool better = false;
        while (!better && damping < kMostDamping) {
            const SharedMatrix s = reduced(bundle, n, damping, inverse);
            SharedVector right_side = -n.slope;
            for (std::size_t v = 0; v < n.poses.size(); ++v)
                right_side += n.poses[v].mixed * (inverse[v] * n.poses[v].slope);
            const SharedVector shared = s.ldlt().solve(right_side);
            for (std::size_t v = 0; v < n.poses.size(); ++v)
                pose_steps[v] = -inverse[v] * (n.poses[v].slope + n.poses[v].mixed.transpose() * shared);

            Bundle trial = bundle;
            step_along(trial, shared, pose_steps);
            const double cost = cost_of(trial);
            better = cost < report.cost; // false for a cost that is no number
            if (better) {
                report.settled = report.cost - cost < kSettled * report.cost;
                report.cost = cost;
                bundle = std::move(trial);
                damping = std::max(kLeastDamping, 0.2 * damping);
            } else {
                damping *= 8;
            }
        }
        if (!better)
            report.settled = true; // no direction leads down any more
        else if (!report.settled)
            n = gather(bundle);
    }
    return report;
}

SharedMatrix inverse_curvature(const Bundle& bundle)
{
    const Normals n = gather(bundle);
    std::vector<Eigen::Matrix<double, 6, 6>> unused;
    SharedMatrix s = reduced(bundle, n, 0, unused);
    // Numbers of very different size: invert with a unit diagonal.
    const SharedVector scale = s.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    s = (scale.asDiagonal() * s * scale.asDiagonal()).eval();
    const Eigen::SelfAdjointEigenSolver<SharedMatrix> eigen(s);
    constexpr double kSingular = 1e-14;
    SharedVector inverse;
    for (int k = 0; k < kShared; ++k)
        inverse[k] = 1 / std::max(eigen.eigenvalues()[k], kSingular);
    s = eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
    s = (scale.asDiagonal() * s * scale.asDiagonal()).eval();
    for (int k = 0; k < kShared; ++k)
        if (!bundle.fitted[static_cast<std::size_t>(k)]) {
            s.row(k).setZero();
            s.col(k).setZero();
        }
    return s;
}

std::vector<Eigen::Vector2d> residuals(const Bundle& bundle, const BundleView& view, bool in_right)
{
    std::vector<Eigen::Vector2d> all;
    for_each_corner(view, [&](bool right, int col, int row, Point2 seen) {
        if (right != in_right)
            return;
        const Term term = corner_term(bundle, view, in_right, col, row, seen);
        all.push_back(term.in_front ? term.residual : Eigen::Vector2d(std::sqrt(kBehind), 0));
    });
    return all;
}

} // namespace dicot::calibration
