#include "report_measures.h"

#include <algorithm>
#include <cmath>

namespace dicot::app {
namespace {

const std::vector<Point2>& corners_of(const calibration::View& view, Eye eye)
{
    return eye == Eye::kLeft ? view.left : view.right;
}

bool has_both(const calibration::View& view)
{
    return !view.left.empty() && !view.right.empty();
}

Point2 middle_of(std::span<const Point2> points)
{
    Point2 sum;
    for (const Point2& p : points)
        sum = {sum.x + p.x, sum.y + p.y};
    const double count = static_cast<double>(points.size());
    return {sum.x / count, sum.y / count};
}

} // namespace

const char* name_of(Eye eye)
{
    return eye == Eye::kLeft ? "left" : "right";
}

std::vector<CornerMiss> corner_misses(const CalibrationRun& run, Eye eye)
{
    std::vector<CornerMiss> misses;
    for (std::size_t v = 0; v < run.task.views.size(); ++v) {
        const std::vector<Point2>& seen = corners_of(run.task.views[v], eye);
        if (!run.calibration.views[v].used || seen.empty())
            continue;
        const std::vector<Point2> predicted =
            calibration::predicted_corners(run.task, run.calibration, v, eye == Eye::kRight);
        for (std::size_t k = 0; k < seen.size(); ++k)
            misses.push_back({seen[k], {seen[k].x - predicted[k].x, seen[k].y - predicted[k].y}});
    }
    return misses;
}

bool is_solved(const CalibrationRun& run)
{
    return !run.calibration.views.empty();
}

const calibration::ViewOutcome* outcome_of(const CalibrationRun& run, const SeenPair& pair)
{
    return pair.view < 0 || !is_solved(run) ? nullptr : &run.calibration.views[static_cast<std::size_t>(pair.view)];
}

bool is_used(const CalibrationRun& run, const SeenPair& pair)
{
    const calibration::ViewOutcome* outcome = outcome_of(run, pair);
    return outcome != nullptr && outcome->used && has_both(run.task.views[static_cast<std::size_t>(pair.view)]);
}

std::string reason_of(const CalibrationRun& run, const SeenPair& pair)
{
    if (is_used(run, pair))
        return "";
    const calibration::ViewOutcome* outcome = outcome_of(run, pair);
    std::string reason = !pair.rejected.empty() ? pair.rejected : outcome != nullptr ? outcome->reason : "";
    if (outcome != nullptr && outcome->used)
        reason += std::string(reason.empty() ? "" : "; ") + "the other picture still helps its own lens";
    return reason;
}

std::optional<std::size_t> middle_pair(const CalibrationRun& run)
{
    const Point2 centre{0.5 * (run.task.width - 1), 0.5 * (run.task.height - 1)};
    std::optional<std::size_t> best;
    double least = 0;
    for (std::size_t p = 0; p < run.pairs.size(); ++p) {
        if (!is_used(run, run.pairs[p]))
            continue;
        const calibration::View& view = run.task.views[static_cast<std::size_t>(run.pairs[p].view)];
        double away = 0;
        for (const Eye eye : kEyes) {
            const Point2 middle = middle_of(corners_of(view, eye));
            away += (middle.x - centre.x) * (middle.x - centre.x) + (middle.y - centre.y) * (middle.y - centre.y);
        }
        if (!best || away < least) {
            best = p;
            least = away;
        }
    }
    return best;
}

std::optional<Point2> rectified(const StereoRig& rig, const Rectification& flat, Eye eye, Point2 pixel)
{
    const bool left = eye == Eye::kLeft;
    const std::optional<Point2> direction = undistort(left ? rig.left : rig.right, pixel);
    if (!direction)
        return std::nullopt;
    const Point3 p = turned(left ? flat.left_rectifying : flat.right_rectifying, {direction->x, direction->y, 1});
    if (!(p.z > 0))
        return std::nullopt;
    return Point2{flat.focal_px * p.x / p.z + flat.cx_px, flat.focal_px * p.y / p.z + flat.cy_px};
}

void RowGaps::add(const StereoRig& rig, const Rectification& flat, std::span<const Point2> left,
                  std::span<const Point2> right)
{
    for (std::size_t k = 0; k < left.size() && k < right.size(); ++k) {
        const std::optional<Point2> l = rectified(rig, flat, Eye::kLeft, left[k]);
        const std::optional<Point2> r = rectified(rig, flat, Eye::kRight, right[k]);
        if (l && r)
            gaps_px.push_back(l->y - r->y);
    }
}

void RowGaps::sum_up()
{
    if (gaps_px.empty())
        return;
    std::vector<double> sizes;
    double squares = 0;
    for (const double gap : gaps_px) {
        sizes.push_back(std::abs(gap));
        squares += gap * gap;
    }
    std::sort(sizes.begin(), sizes.end());
    const double last = static_cast<double>(sizes.size() - 1);
    rms_px = std::sqrt(squares / static_cast<double>(sizes.size()));
    p95_px = sizes[static_cast<std::size_t>(0.95 * last)];
    most_px = sizes.back();
}

RowGaps row_gaps(const CalibrationRun& run, const Rectification& flat)
{
    RowGaps gaps;
    for (std::size_t v = 0; v < run.task.views.size(); ++v)
        if (run.calibration.views[v].used)
            gaps.add(run.calibration.rig, flat, run.task.views[v].left, run.task.views[v].right);
    gaps.sum_up();
    return gaps;
}

bool part_is_empty(const calibration::Coverage& coverage, std::size_t part)
{
    constexpr std::array<int, 4> kCols{0, 3, 5, calibration::kCoverageCols};
    constexpr std::array<int, 4> kRows{0, 2, 4, calibration::kCoverageRows};
    int cells = 0;
    int empty = 0;
    for (int row = kRows[part / 3]; row < kRows[part / 3 + 1]; ++row)
        for (int col = kCols[part % 3]; col < kCols[part % 3 + 1]; ++col) {
            ++cells;
            empty += coverage.corners[static_cast<std::size_t>(row * calibration::kCoverageCols + col)] == 0 ? 1 : 0;
        }
    return 2 * empty > cells;
}

std::vector<std::string> empty_parts(const calibration::Coverage& coverage)
{
    std::vector<std::string> parts;
    for (std::size_t part = 0; part < kPartNames.size(); ++part)
        if (part_is_empty(coverage, part))
            parts.emplace_back(kPartNames[part]);
    return parts;
}

double baseline_deviation_mm(const calibration::StereoCalibration& calibration)
{
    constexpr std::size_t kShift = 21; // first of the three numbers of shift_mm
    const Point3& shift = calibration.rig.shift_mm;
    const double length = calibration.rig.baseline_mm();
    const std::array<double, 3> along{shift.x / length, shift.y / length, shift.z / length};
    double variance = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            variance +=
                along[i] * along[j] * calibration.covariance[(kShift + i) * calibration::kRigNumbers + kShift + j];
    return std::sqrt(variance);
}

} // namespace dicot::app
