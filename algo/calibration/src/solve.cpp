#include "dicot/calibration/solve.h"

#include "bundle.h"
#include "closed_form.h"
#include "lens_fit.h"
#include "refusals.h"
#include "words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dicot::calibration {

namespace {

constexpr double kSameTurn = 0.985; // cosine of 10 degrees
constexpr double kOutlierRatio = 4; // of the median view's RMS
constexpr double kOutlierLeast_px = 0.4;
constexpr double kMovedRatio = 3; // of a view's RMS in one camera alone
constexpr double kRoughLoss_px = 1.5;
constexpr double kLossDeviations = 3;
constexpr double kLeastDeviation_px = 0.01;
constexpr int kMaxIterations = 80;

Bundle bundle_of(const CalibrationTask& task)
{
    Bundle bundle;
    for (const View& view : task.views)
        bundle.views.push_back({&task.boards[static_cast<std::size_t>(view.board)],
                                view.left,
                                view.right,
                                {},
                                !view.left.empty() || !view.right.empty()});
    std::fill(bundle.fitted.begin(), bundle.fitted.end(), true);
    for (const int first : {kLeftLens, kRightLens})
        bundle.fitted[static_cast<std::size_t>(first) + 8] = task.fit_k3;
    bundle.fitted[kWarp] = bundle.fitted[kWarp + 1] = task.fit_warp;
    bundle.loss = Loss::kHuber;
    return bundle;
}

bool is_pair(const BundleView& view)
{
    return !view.left.empty() && !view.right.empty();
}

double rms_of(const Bundle& bundle, const BundleView& view, bool in_right)
{
    double sum = 0;
    const std::vector<Eigen::Vector2d> all = residuals(bundle, view, in_right);
    for (const Eigen::Vector2d& r : all)
        sum += r.squaredNorm();
    return all.empty() ? 0 : std::sqrt(sum / static_cast<double>(all.size()));
}

double worse_rms(const Bundle& bundle, const BundleView& view)
{
    return std::max(rms_of(bundle, view, false), rms_of(bundle, view, true));
}

double deviation_px(const Bundle& bundle)
{
    std::vector<double> coordinates;
    for (const BundleView& view : bundle.views)
        if (view.used)
            for (const bool in_right : {false, true})
                for (const Eigen::Vector2d& r : residuals(bundle, view, in_right)) {
                    coordinates.push_back(r.x());
                    coordinates.push_back(r.y());
                }
    return std::max(robust_deviation(std::move(coordinates)), kLeastDeviation_px);
}

/// Starts the rig from the views that agree on it, and drops the pairs that do not: their corners are in another order.
void start_rig(Bundle& bundle, const std::array<LensFit, 2>& lens, std::vector<std::string>& reasons)
{
    std::vector<std::size_t> pairs;
    std::vector<Pose> rigs;
    for (std::size_t v = 0; v < bundle.views.size(); ++v)
        if (bundle.views[v].used && is_pair(bundle.views[v])) {
            Pose rig;
            rig.turn = lens[1].poses[v].turn * lens[0].poses[v].turn.conjugate();
            rig.shift = lens[1].poses[v].shift - rig.turn * lens[0].poses[v].shift;
            pairs.push_back(v);
            rigs.push_back(rig);
        }
    const auto alike = [&](const Pose& p, const Pose& q) {
        // The cosine of half the angle between two turns is |p . q|.
        const double half = std::abs(p.turn.dot(q.turn));
        return 2 * half * half - 1 > kSameTurn;
    };
    std::size_t best = 0;
    std::ptrdiff_t most = -1;
    for (std::size_t k = 0; k < rigs.size(); ++k) {
        const auto friends = std::count_if(rigs.begin(), rigs.end(), [&](const Pose& q) { return alike(rigs[k], q); });
        if (friends > most) {
            most = friends;
            best = k;
        }
    }
    std::vector<Eigen::Quaterniond> turns;
    std::array<std::vector<double>, 3> shifts;
    for (std::size_t k = 0; k < rigs.size(); ++k) {
        if (!alike(rigs[best], rigs[k])) {
            bundle.views[pairs[k]].used = false;
            reasons[pairs[k]] = "left and right name different corners of the board, or do not show the same moment";
            continue;
        }
        turns.push_back(rigs[k].turn);
        for (int axis = 0; axis < 3; ++axis)
            shifts[static_cast<std::size_t>(axis)].push_back(rigs[k].shift[axis]);
    }
    bundle.rig.turn = mean_turn(turns);
    for (int axis = 0; axis < 3; ++axis)
        bundle.rig.shift[axis] = median(std::move(shifts[static_cast<std::size_t>(axis)]));
}

/// Drops views whose corners fit much worse than those of the others.
bool drop_outliers(Bundle& bundle, const std::array<LensFit, 2>& lens, std::vector<std::string>& reasons)
{
    std::vector<double> all;
    for (const BundleView& view : bundle.views)
        if (view.used)
            all.push_back(worse_rms(bundle, view));
    const double limit = std::max(kOutlierRatio * median(std::move(all)), kOutlierLeast_px);
    bool dropped = false;
    for (std::size_t v = 0; v < bundle.views.size(); ++v) {
        BundleView& view = bundle.views[v];
        const double rms = view.used ? worse_rms(bundle, view) : 0;
        if (!view.used || rms <= limit)
            continue;
        view.used = false;
        dropped = true;
        const double alone = std::max(lens[0].rms_px[v], lens[1].rms_px[v]);
        if (is_pair(view) && rms > kMovedRatio * alone)
            reasons[v] =
                text("left and right fit by themselves (%.2f px) but not together (%.2f px); did the board move "
                     "between the two pictures?",
                     alone, rms);
        else
            reasons[v] =
                text("corners are off by %.2f px where the others are off by %.2f px; blurred, or a bent board?", rms,
                     limit / kOutlierRatio);
    }
    return dropped;
}

StereoCalibration outcome(const CalibrationTask& task, const Bundle& bundle, std::vector<std::string> reasons)
{
    StereoCalibration c;
    c.rig = {task.width,
             task.height,
             lens_of(bundle.lens[0]),
             lens_of(bundle.lens[1]),
             turn_of(bundle.rig.turn),
             {bundle.rig.shift.x(), bundle.rig.shift.y(), bundle.rig.shift.z()}};
    c.warp_mm = {bundle.warp[0], bundle.warp[1]};
    std::array<double, 2> sums{};
    std::array<double, 2> counts{};
    int poses = 0;
    for (std::size_t v = 0; v < bundle.views.size(); ++v) {
        const BundleView& view = bundle.views[v];
        ViewOutcome o;
        o.used = view.used;
        o.reason = std::move(reasons[v]);
        o.turn = turn_of(view.pose.turn);
        o.shift_mm = {view.pose.shift.x(), view.pose.shift.y(), view.pose.shift.z()};
        o.rms_left_px = rms_of(bundle, view, false);
        o.rms_right_px = rms_of(bundle, view, true);
        if (view.used) {
            c.pairs_used += is_pair(view) ? 1 : 0;
            ++poses;
            sums[0] += o.rms_left_px * o.rms_left_px * static_cast<double>(view.left.size());
            sums[1] += o.rms_right_px * o.rms_right_px * static_cast<double>(view.right.size());
            counts[0] += static_cast<double>(view.left.size());
            counts[1] += static_cast<double>(view.right.size());
        }
        c.views.push_back(std::move(o));
    }
    c.rms_left_px = std::sqrt(sums[0] / counts[0]);
    c.rms_right_px = std::sqrt(sums[1] / counts[1]);
    c.rms_px = std::sqrt((sums[0] + sums[1]) / (counts[0] + counts[1]));
    const auto fitted = std::count(bundle.fitted.begin(), bundle.fitted.end(), true);
    const double freedom = 2 * (counts[0] + counts[1]) - 6.0 * poses - static_cast<double>(fitted);
    c.sigma_px = std::sqrt((sums[0] + sums[1]) / std::max(freedom, 1.0));

    const SharedMatrix covariance = c.sigma_px * c.sigma_px * inverse_curvature(bundle);
    for (int row = 0; row < kRigNumbers; ++row)
        for (int col = 0; col < kRigNumbers; ++col)
            c.covariance[static_cast<std::size_t>(row * kRigNumbers + col)] = covariance(row, col);
    return c;
}

} // namespace

double StereoCalibration::deviation(int number) const
{
    return std::sqrt(covariance[static_cast<std::size_t>(number * (kRigNumbers + 1))]);
}

Result<StereoCalibration> solve_stereo(const CalibrationTask& task)
{
    TRY(check_task(task));
    std::array<LensFit, 2> lens;
    for (const std::size_t side : {0U, 1U}) {
        std::vector<Sight> sights;
        for (const View& view : task.views)
            sights.push_back({&task.boards[static_cast<std::size_t>(view.board)], side == 0 ? view.left : view.right});
        lens[side] = fit_lens(sights, task.width, task.height, task.fit_k3);
        TRY(check_variety(lens[side], side == 0 ? "left" : "right"));
    }

    Bundle bundle = bundle_of(task);
    std::vector<std::string> reasons(task.views.size());
    for (std::size_t v = 0; v < task.views.size(); ++v)
        if (!bundle.views[v].used)
            reasons[v] = "the board was found in neither picture";
    bundle.lens = {lens[0].lens, lens[1].lens};
    start_rig(bundle, lens, reasons);
    for (std::size_t v = 0; v < bundle.views.size(); ++v) {
        BundleView& view = bundle.views[v];
        view.pose = lens[0].poses[v];
        if (view.left.empty() && view.used) {
            view.pose.turn = bundle.rig.turn.conjugate() * lens[1].poses[v].turn;
            view.pose.shift = bundle.rig.turn.conjugate() * (lens[1].poses[v].shift - bundle.rig.shift);
        }
    }

    bundle.loss_scale_px = kRoughLoss_px;
    minimise(bundle, kMaxIterations);
    while (drop_outliers(bundle, lens, reasons))
        minimise(bundle, kMaxIterations);
    bundle.loss_scale_px = kLossDeviations * deviation_px(bundle);
    minimise(bundle, kMaxIterations);
    while (drop_outliers(bundle, lens, reasons))
        minimise(bundle, kMaxIterations);

    StereoCalibration result = outcome(task, bundle, std::move(reasons));
    if (result.pairs_used < kMinPairs)
        return failure(Fault::kBadData,
                       "only %d of %zu pairs fit together; at least %d are needed. Were the pictures taken at "
                       "the same moments by two cameras that stand still to each other?",
                       result.pairs_used, task.views.size(), kMinPairs);
    TRY(check_sides(result.rig.shift_mm));
    return result;
}

std::vector<Point2> predicted_corners(const CalibrationTask& task, const StereoCalibration& calibration,
                                      std::size_t view, bool in_right)
{
    const Board& board = task.boards[static_cast<std::size_t>(task.views[view].board)];
    const ViewOutcome& pose = calibration.views[view];
    const StereoRig& rig = calibration.rig;
    std::vector<Point2> corners;
    for (int row = 0; row < board.rows; ++row)
        for (int col = 0; col < board.cols; ++col) {
            const Eigen::Vector3d on_board =
                board_point(board, {calibration.warp_mm[0], calibration.warp_mm[1]}, col, row);
            const Point3 turned_only = turned(pose.turn, {on_board.x(), on_board.y(), on_board.z()});
            Point3 at{turned_only.x + pose.shift_mm.x, turned_only.y + pose.shift_mm.y,
                      turned_only.z + pose.shift_mm.z};
            if (in_right)
                at = rig.into_right(at);
            constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
            corners.push_back(at.z > 0 ? project(in_right ? rig.right : rig.left, at) : Point2{kNone, kNone});
        }
    return corners;
}

StereoCalibration solve_again(const CalibrationTask& task, const StereoCalibration& start, std::span<const bool> chosen)
{
    Bundle bundle = bundle_of(task);
    bundle.lens = {lens_vector(start.rig.left), lens_vector(start.rig.right)};
    bundle.rig.turn = quaternion_of(start.rig.turn);
    const Point3& shift = start.rig.shift_mm;
    bundle.rig.shift = {shift.x, shift.y, shift.z};
    bundle.warp = {start.warp_mm[0], start.warp_mm[1]};
    std::vector<std::string> reasons(task.views.size());
    for (std::size_t v = 0; v < task.views.size(); ++v) {
        const ViewOutcome& before = start.views[v];
        bundle.views[v].used = before.used && chosen[v];
        bundle.views[v].pose.turn = quaternion_of(before.used ? before.turn : Turn{1, 0, 0, 0, 1, 0, 0, 0, 1});
        bundle.views[v].pose.shift = {before.shift_mm.x, before.shift_mm.y, before.shift_mm.z};
        reasons[v] = before.reason;
    }
    bundle.loss_scale_px = kLossDeviations * start.sigma_px;
    minimise(bundle, kMaxIterations);
    return outcome(task, bundle, std::move(reasons));
}

} // namespace dicot::calibration
