// One plant about a metre away by four baselines: what a longer one gains in depth and loses by what the right camera
// does not see.
#include "calibration_data.h"
#include "matched.h"
#include "rectified_view.h"
#include "temp_folder.h"

#include "calibrate/report_plot.h"
#include "calibrate/report_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace dicot::test {
namespace {

constexpr std::array kBaselines{45, 65, 85, 105};
constexpr WorkingRange kSearch{700, 1350}; // the plant stands within it
constexpr int kAround = 64;                // px of the picture around what is judged

/// What one baseline gives on the leaves. Shares in percent.
struct BaselineFigures
{
    int baseline_mm = 0;
    double step_mm = 0;            ///< eq. 21 for half a px, at the leaves' median depth
    double hidden = 0;             ///< leaf pixels that the right camera does not see
    double valued = 0;             ///< of those that both see
    double median_mm = 0;          ///< of the error's size, of those with a value
    double median_px = 0;          ///< the same as a disparity
    double rms_mm = 0;             ///< of those that are no mismatch
    double mismatched = 0;         ///< of those with a value: disparity off by more than 1 px
    double lost = 0;               ///< of all leaf pixels of the left picture: hidden, without a value, or mismatched
    std::array<double, 3> right{}; ///< of the same: within kRightMm of the truth

    /// Least where a longer baseline begins to lose, in proportion, more pixels than it gains depth.
    double trade() const { return rms_mm * lost / 100; }
};
constexpr std::array<double, 3> kRightMm{3, 5, 10};

std::string baseline_path(const std::string& name)
{
    return data_path("rig-dev/baseline/" + name);
}

std::string numbered(int baseline_mm)
{
    char text[8];
    std::snprintf(text, sizeof text, "b%03d", baseline_mm);
    return text;
}

double median_of(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

scenes::Picture cut(const scenes::Picture& from, int first, int end, int top, int bottom)
{
    scenes::Picture part{end - first, bottom - top, {}};
    for (int y = top; y < bottom; ++y)
        part.pixels.insert(part.pixels.end(), from.view().row(y) + first, from.view().row(y) + end);
    return part;
}

/// Disparities of the rectified pictures where the leaves are; NaN elsewhere.
Disparities match_leaves(const RectifiedView& view, const TrueDepth& truth, const scenes::Picture& left,
                         const scenes::Picture& right)
{
    const DisparityRange search = disparity_range(view.geometry(), kSearch).value();
    double first = 1e9, end = 0, top = 1e9, bottom = 0;
    for (std::size_t i = 0; i < truth.pixels(); ++i) {
        if (truth.kind[i] != Kind::kLeaf)
            continue;
        const int x = static_cast<int>(i) % truth.width, y = static_cast<int>(i) / truth.width;
        const auto ray = undistort(view.rig().left, {double(x), double(y)}).value();
        const Point2 at = view.seen({ray.x, ray.y, 1}).pixel;
        first = std::min(first, at.x), end = std::max(end, at.x);
        top = std::min(top, at.y), bottom = std::max(bottom, at.y);
    }
    const int x0 = std::max(search.min_disparity, int(first) - kAround - search.disparities);
    const int x1 = std::min(left.width, int(end) + kAround + search.disparities);
    const int y0 = std::max(0, int(top) - kAround), y1 = std::min(left.height, int(bottom) + kAround);
    MatchOptions options = view.options(MatchMethod::kBest);
    options.min_disparity = 0;
    options.disparities = search.disparities;
    const Matched matched(cut(left, x0, x1, y0, y1).view(),
                          cut(right, x0 - search.min_disparity, x1 - search.min_disparity, y0, y1).view(), options);
    const Disparities part = disparities_of(matched.map());
    Disparities whole{left.width, left.height, std::vector<float>(left.pixels.size(), NAN), {}};
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
            whole.px[std::size_t(y) * std::size_t(left.width) + std::size_t(x)] =
                float(search.min_disparity) + part.px[std::size_t(y - y0) * std::size_t(x1 - x0) + std::size_t(x - x0)];
    return whole;
}

BaselineFigures figures_with(int baseline_mm)
{
    const std::string number = numbered(baseline_mm);
    const TrueDepth truth = read_truth(baseline_path(""), "gt_visible_right_" + number + ".png");
    const RectifiedView view(true_rig("rig-dev/baseline/gt_calib_" + number + ".json"));
    const RawDepth depth =
        view.on_raw_pixels(match_leaves(view, truth, view.left(scenes::read(baseline_path("left.jpg"))),
                                        view.right(scenes::read(baseline_path("right_" + number + ".jpg")))));
    const double depth_px_mm = view.geometry().focal_px * view.geometry().baseline_mm;
    std::vector<double> errors_mm, errors_px, depths;
    const double leaves = double(std::ranges::count(truth.kind, Kind::kLeaf));
    double both = 0, mismatched = 0, squares = 0;
    std::array<double, 3> right{};
    for (std::size_t i = 0; i < truth.pixels(); ++i) {
        if (truth.kind[i] != Kind::kLeaf)
            continue;
        const double z = truth.mm[i], off_mm = std::fabs(double(depth.mm[i]) - z);
        depths.push_back(z);
        for (std::size_t k = 0; k < right.size(); ++k)
            right[k] += off_mm <= kRightMm[k] ? 100 / leaves : 0; // not where there is no value
        if (!truth.leaf[i])
            continue;
        ++both;
        if (std::isnan(off_mm))
            continue;
        errors_mm.push_back(off_mm);
        errors_px.push_back(std::fabs(depth_px_mm / double(depth.mm[i]) - depth_px_mm / z));
        const bool wrong = errors_px.back() > 1;
        mismatched += wrong ? 1 : 0;
        squares += wrong ? 0 : off_mm * off_mm;
    }
    const double valued = double(errors_mm.size());
    const double typical = median_of(depths);
    return {baseline_mm,
            0.5 * typical * typical / depth_px_mm,
            100 * (leaves - both) / leaves,
            100 * valued / both,
            median_of(errors_mm),
            median_of(errors_px),
            std::sqrt(squares / (valued - mismatched)),
            100 * mismatched / valued,
            100 - 100 * (valued - mismatched) / leaves,
            right};
}

void draw(const std::vector<BaselineFigures>& all)
{
    using namespace app::svg;
    std::vector<PlotPoint> bound, median, rms, hidden, mismatched, lost;
    for (const BaselineFigures& f : all) {
        bound.emplace_back(f.baseline_mm, f.step_mm);
        median.emplace_back(f.baseline_mm, f.median_mm);
        rms.emplace_back(f.baseline_mm, f.rms_mm);
        hidden.emplace_back(f.baseline_mm, f.hidden);
        mismatched.emplace_back(f.baseline_mm, f.mismatched);
        lost.emplace_back(f.baseline_mm, f.lost);
    }
    const auto most = [](const std::vector<PlotPoint>& points) {
        return std::ranges::max_element(points, {}, &PlotPoint::second)->second;
    };
    const Scale across = Scale::around(40, 110, 7, "mm");
    Plot depth(760, 320, across, Scale::around(0, most(bound), 6, "mm"), "Depth error over the baseline");
    Plot share(760, 320, across, Scale::around(0, std::max({most(hidden), most(mismatched), most(lost)}), 6, "%"),
               "Mismatched and hidden leaf pixels over the baseline");
    const auto add = [](Plot& plot, const std::vector<PlotPoint>& points, const char* kind, const char* name) {
        plot.curve(points, kind);
        const bool falls = points.back().second < points.front().second;
        const auto& [x, y] = falls ? points.front() : points.back(); // its highest place: no curve of its own above
        plot.note(x, y, falls ? "label" : "label end", name);
    };
    add(depth, bound, "mark", "eq. 21, half a px");
    add(depth, rms, "trace right", "RMS without mismatches");
    add(depth, median, "trace", "median");
    add(share, lost, "mark", "lost: hidden, mismatched, no value");
    add(share, hidden, "trace right", "hidden");
    add(share, mismatched, "trace", "mismatched");
    std::filesystem::create_directories(DICOT_PICTURES_DIR);
    for (const auto& [name, plot] : {std::pair{"baseline_depth.svg", &depth}, {"baseline_mismatch.svg", &share}}) {
        const std::string path = std::string(DICOT_PICTURES_DIR) + "/" + name;
        std::ofstream(path) << standalone(plot->drawn());
        std::printf("%s\n", path.c_str());
    }
}

TEST(Baseline, ALongerOneMeasuresFinerAndSeesLess)
{
    if (!data_there("rig-dev/baseline"))
        return;
    std::vector<BaselineFigures> all;
    std::printf(
        "| baseline | eq. 21   | median  | median   | RMS without mismatches | mismatched | hidden  | valued  | "
        "lost of all | RMS x lost | of all leaf pixels within 3, 5, 10 mm |\n");
    for (const int baseline_mm : kBaselines) {
        const BaselineFigures f = figures_with(baseline_mm);
        std::printf(
            "| %5d mm | %5.2f mm | %4.2f mm | %.3f px | %19.2f mm | %8.2f %% | %5.2f %% | %5.2f %% | %9.2f %% | "
            "%7.3f mm | %21.2f %5.2f %5.2f %% |\n",
            f.baseline_mm, f.step_mm, f.median_mm, f.median_px, f.rms_mm, f.mismatched, f.hidden, f.valued, f.lost,
            f.trade(), f.right[0], f.right[1], f.right[2]);
        std::fflush(stdout);
        EXPECT_LT(f.median_mm, f.step_mm) << "no better than whole disparities at " << baseline_mm << " mm";
        all.push_back(f);
    }
    draw(all);
    const auto best = std::ranges::min_element(all, {}, &BaselineFigures::trade);
    std::printf("best of these: %d mm, where error times loss is least\n", best->baseline_mm);
    EXPECT_GT(best->baseline_mm, kBaselines.front()) << "the shortest one measures too coarsely to be the best";
    for (std::size_t k = 1; k < all.size(); ++k) {
        EXPECT_LT(all[k].median_mm, all[k - 1].median_mm) << "a longer baseline measures finer";
        EXPECT_GT(all[k].hidden, all[k - 1].hidden) << "and hides more";
    }
    EXPECT_LT(all.back().valued, all.front().valued) << "and its pictures differ more";
}

} // namespace
} // namespace dicot::test
