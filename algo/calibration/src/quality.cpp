#include "dicot/calibration/quality.h"

#include "bundle.h"
#include "held_out.h"
#include "words.h"

#include "dicot/calibration/camera.h"

#include <algorithm>
#include <cmath>

namespace dicot::calibration {

namespace {

constexpr std::array<double, 3> kDistances_mm{500, 800, 1000};

void count_coverage(const CalibrationTask& task, const StereoCalibration& calibration, Quality& quality)
{
    for (std::size_t v = 0; v < task.views.size(); ++v)
        if (calibration.views[v].used) {
            add_corners(quality.left, task.views[v].left, task.width, task.height);
            add_corners(quality.right, task.views[v].right, task.width, task.height);
        }
}

void count_distances(const CalibrationTask& task, const StereoCalibration& calibration, const WorkingRange& range,
                     Quality& quality)
{
    bool first = true;
    for (std::size_t v = 0; v < task.views.size(); ++v) {
        const ViewOutcome& outcome = calibration.views[v];
        if (!outcome.used)
            continue;
        const Board& board = task.boards[static_cast<std::size_t>(task.views[v].board)];
        for (const int col : {0, board.cols - 1})
            for (const int row : {0, board.rows - 1}) {
                const Eigen::Vector3d p = board_point(board, Eigen::Vector2d::Zero(), col, row);
                const double z =
                    outcome.turn[6] * p.x() + outcome.turn[7] * p.y() + outcome.turn[8] * p.z() + outcome.shift_mm.z;
                quality.nearest_mm = first ? z : std::min(quality.nearest_mm, z);
                quality.farthest_mm = first ? z : std::max(quality.farthest_mm, z);
                first = false;
            }
        const double share = (outcome.shift_mm.z - range.near_mm) / (range.far_mm - range.near_mm);
        if (share >= 0 && share <= 1)
            ++quality.boards_by_distance[static_cast<std::size_t>(
                std::min(static_cast<int>(share * kDistanceBins), kDistanceBins - 1))];
    }
}

void measure_epipolar(const CalibrationTask& task, const StereoCalibration& calibration, Quality& quality)
{
    std::vector<double> distances;
    double squares = 0;
    for (std::size_t v = 0; v < task.views.size(); ++v) {
        const View& view = task.views[v];
        if (!calibration.views[v].used || view.left.empty() || view.right.empty())
            continue;
        for (std::size_t k = 0; k < view.left.size(); ++k)
            if (const auto d = epipolar_distance_px(calibration.rig, view.left[k], view.right[k])) {
                distances.push_back(*d);
                squares += *d * *d;
            }
    }
    if (distances.empty())
        return;
    quality.epipolar_rms_px = std::sqrt(squares / static_cast<double>(distances.size()));
    const auto at = distances.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(distances.size() - 1));
    std::nth_element(distances.begin(), at, distances.end());
    quality.epipolar_p95_px = *at;
}

/// The regions of the picture without a corner, in words.
std::string empty_regions(const Coverage& coverage)
{
    const auto empty_share = [&](int col0, int col1, int row0, int row1) {
        int empty = 0;
        for (int row = row0; row < row1; ++row)
            for (int col = col0; col < col1; ++col)
                empty += coverage.corners[static_cast<std::size_t>(row * kCoverageCols + col)] == 0 ? 1 : 0;
        return static_cast<double>(empty) / ((col1 - col0) * (row1 - row0));
    };
    struct Region
    {
        const char* name;
        double empty;
    };
    const std::array<Region, 4> regions{{{"left", empty_share(0, 2, 0, kCoverageRows)},
                                         {"right", empty_share(kCoverageCols - 2, kCoverageCols, 0, kCoverageRows)},
                                         {"upper", empty_share(0, kCoverageCols, 0, 2)},
                                         {"lower", empty_share(0, kCoverageCols, kCoverageRows - 2, kCoverageRows)}}};
    std::string names;
    for (const Region& region : regions)
        if (region.empty > 0.5)
            names += (names.empty() ? "" : ", ") + std::string(region.name);
    return names;
}

void judge(const StereoCalibration& calibration, const WorkingRange& range, Quality& quality)
{
    int worst = 0;
    const auto gate = [&](bool good, bool usable, std::string advice) {
        if (good)
            return;
        worst = std::max(worst, usable ? 1 : 2);
        // What forbids the use comes first.
        quality.advice.insert(usable ? quality.advice.end() : quality.advice.begin(), std::move(advice));
    };
    gate(
        quality.epipolar_rms_px <= kEpipolarGate_px.good, quality.epipolar_rms_px <= kEpipolarGate_px.usable,
        text("rows of the two pictures miss each other by %.2f px: take sharp pictures at the same moment, with a flat "
             "board",
             quality.epipolar_rms_px));
    const DepthError& far = quality.depth_at_far;
    const double far_percent = 100 * far.calibration_mm / far.distance_mm;
    gate(
        far_percent <= kDepthGate_percent.good, far_percent <= kDepthGate_percent.usable,
        text(
            "depth at %.0f mm is uncertain by %.1f mm: take more pairs, the board tilted by 20 to 40 degrees, near and "
            "far",
            far.distance_mm, far.calibration_mm));
    gate(quality.held_out_size_percent <= kDepthGate_percent.good,
         quality.held_out_size_percent <= kDepthGate_percent.usable,
         text("boards that were held out come out %.2f %% wrong in size: take more pairs at different distances and "
              "tilts",
              quality.held_out_size_percent));
    gate(calibration.pairs_used >= kPairsGate.good, calibration.pairs_used >= kPairsGate.usable,
         text("%d pairs were used: take at least %d, better 15 to 25", calibration.pairs_used, kPairsGate.good));
    const Coverage& thinner = quality.left.share < quality.right.share ? quality.left : quality.right;
    const std::string regions = empty_regions(thinner);
    gate(thinner.share >= kCoverageGate.good, thinner.share >= kCoverageGate.usable,
         text("corners reach only %.0f %% of the %s picture: show the board %s%s%s too", 100 * thinner.share,
              &thinner == &quality.left ? "left" : "right", regions.empty() ? "near all borders" : "in its ",
              regions.c_str(), regions.empty() ? "" : " part"));
    constexpr std::array<const char*, kDistanceBins> kThirds{"near", "middle", "far"};
    for (std::size_t bin = 0; bin < kDistanceBins; ++bin) {
        const double from = range.near_mm + static_cast<double>(bin) * (range.far_mm - range.near_mm) / kDistanceBins;
        gate(quality.boards_by_distance[bin] > 0, true,
             text("no board stood in the %s third of the working range (%.0f to %.0f mm)", kThirds[bin], from,
                  from + (range.far_mm - range.near_mm) / kDistanceBins));
    }
    quality.verdict = worst == 0 ? Verdict::kGood : worst == 1 ? Verdict::kUsable : Verdict::kRedo;
}

} // namespace

const char* name_of(Verdict verdict)
{
    switch (verdict) {
    case Verdict::kGood:
        return "good";
    case Verdict::kUsable:
        return "usable";
    case Verdict::kRedo:
        return "redo";
    }
    return "";
}

void add_corners(Coverage& coverage, std::span<const Point2> corners, int width, int height)
{
    for (const Point2& p : corners) {
        const int col = std::clamp(static_cast<int>((p.x + 0.5) * kCoverageCols / width), 0, kCoverageCols - 1);
        const int row = std::clamp(static_cast<int>((p.y + 0.5) * kCoverageRows / height), 0, kCoverageRows - 1);
        ++coverage.corners[static_cast<std::size_t>(row * kCoverageCols + col)];
    }
    coverage.share = static_cast<double>(std::count_if(coverage.corners.begin(), coverage.corners.end(),
                                                       [](int count) { return count > 0; })) /
                     (kCoverageCols * kCoverageRows);
}

Quality assess(const CalibrationTask& task, const StereoCalibration& calibration, const WorkingRange& range)
{
    Quality quality;
    const HeldOut held_out = cross_validate(task, calibration, kFolds);
    quality.held_out_mm = held_out.shape_mm;
    quality.held_out_depth_mm = held_out.depth_mm;
    quality.held_out_size_percent = held_out.size_percent;
    quality.held_out_pairs = held_out.pairs;
    measure_epipolar(task, calibration, quality);
    for (const double distance_mm : kDistances_mm)
        quality.depth.push_back(predict_depth_error(calibration, distance_mm));
    quality.depth_at_far = predict_depth_error(calibration, range.far_mm);
    count_coverage(task, calibration, quality);
    count_distances(task, calibration, range, quality);
    judge(calibration, range, quality);
    return quality;
}

} // namespace dicot::calibration
