#include "refusals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dicot::calibration {

namespace {

constexpr double kMostFocalDeviation = 0.02; // relative; beyond it the views do not determine the lens
constexpr double kLeastTiltSpread_deg = 8;

Status check_side(const CalibrationTask& task, std::size_t index, const std::vector<Point2>& corners, const char* side)
{
    const Board& board = task.boards[static_cast<std::size_t>(task.views[index].board)];
    if (corners.empty())
        return {};
    if (corners.size() != static_cast<std::size_t>(board.corner_count()))
        return failure(Fault::kBadData, "view %zu, %s: %zu corners on a board of %d", index, side, corners.size(),
                       board.corner_count());
    for (const Point2& p : corners)
        if (!(p.x > -1 && p.y > -1 && p.x < task.width && p.y < task.height))
            return failure(Fault::kBadData, "view %zu, %s: a corner at (%g, %g) lies outside the %d x %d picture",
                           index, side, p.x, p.y, task.width, task.height);
    return {};
}

} // namespace

Status check_task(const CalibrationTask& task)
{
    if (task.width < 32 || task.height < 32)
        return failure(Fault::kBadData, "pictures of %d x %d are too small to calibrate with", task.width, task.height);
    for (const Board& board : task.boards)
        TRY(check_board(board));
    std::array<int, 3> seen{}; // left, right, both
    for (std::size_t v = 0; v < task.views.size(); ++v) {
        const View& view = task.views[v];
        if (view.board < 0 || static_cast<std::size_t>(view.board) >= task.boards.size())
            return failure(Fault::kBadData, "view %zu names board %d, which is not there", v, view.board);
        TRY(check_side(task, v, view.left, "left"));
        TRY(check_side(task, v, view.right, "right"));
        seen[0] += view.left.empty() ? 0 : 1;
        seen[1] += view.right.empty() ? 0 : 1;
        seen[2] += view.left.empty() || view.right.empty() ? 0 : 1;
    }
    for (const std::size_t side : {0U, 1U})
        if (seen[side] == 0 && seen[1 - side] > 0)
            return failure(Fault::kBadData,
                           "only the %s camera saw the board; take pairs that show the whole board in both",
                           side == 0 ? "right" : "left");
    if (seen[2] < kMinPairs)
        return failure(Fault::kBadData,
                       "%d pairs show the whole board in both pictures; at least %d are needed, 15 or more "
                       "at different distances and tilts make a good calibration",
                       seen[2], kMinPairs);
    return {};
}

Status check_variety(const LensFit& fit, const char* side)
{
    if (fit.tilt_spread_deg < kLeastTiltSpread_deg)
        return failure(Fault::kBadData,
                       "all views are alike: the board's tilt changes by %.1f degrees (%s camera); turn it "
                       "by 20 to 40 degrees to all four sides, nearer and farther",
                       fit.tilt_spread_deg, side);
    if (!(fit.focal_deviation < kMostFocalDeviation))
        return failure(Fault::kBadData,
                       "all views are too much alike to find the focal length of the %s camera (+- %.0f %%); "
                       "turn the board by 20 to 40 degrees to all four sides, nearer and farther",
                       side, std::min(100 * fit.focal_deviation, 999.0));
    return {};
}

Status check_sides(const Point3& shift_mm)
{
    const double sideways = std::abs(shift_mm.x);
    if (sideways < std::abs(shift_mm.y) || sideways < std::abs(shift_mm.z))
        return failure(Fault::kBadData,
                       "the cameras do not stand side by side: the right one is at x %.0f, y %.0f, z %.0f mm "
                       "of the left one",
                       -shift_mm.x, -shift_mm.y, -shift_mm.z);
    if (shift_mm.x > 0)
        return failure(Fault::kBadData,
                       "left and right are swapped: the right camera stands %.0f mm to the left of the left "
                       "one; exchange the pictures",
                       sideways);
    return {};
}

} // namespace dicot::calibration
