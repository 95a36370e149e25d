#include "report_svg.h"

#include "report_shapes.h"
#include "report_text.h"

#include <algorithm>
#include <cmath>

namespace dicot::app {
namespace {

using calibration::kCoverageCols;
using calibration::kCoverageRows;
using calibration::kDistanceBins;
using namespace svg;

} // namespace

std::string shared_drawings()
{
    std::string all = R"(<svg class="shared" width="0" height="0" aria-hidden="true"><defs>)"
                      R"(<pattern id="hatch" width="6" height="6" patternUnits="userSpaceOnUse">)"
                      R"(<path class="hatch" d="M-1 7L7 -1M-1 1L1 -1M5 7L7 5"/></pattern>)";
    for (int colour = 0; colour < 7; ++colour)
        all += fill(R"(<marker id="ring{}" viewBox="-4 -4 8 8" markerWidth="8" markerHeight="8" )"
                    R"(markerUnits="strokeWidth"><circle r="2.6" class="ring row{}"/></marker>)",
                    {colour, colour});
    return all + "</defs></svg>\n";
}

std::string coverage_chart(const CalibrationRun& run, Eye eye, std::span<const CornerMiss> corners)
{
    constexpr double kWidth = 500;
    const double height = kWidth * run.task.height / run.task.width;
    const calibration::Coverage& coverage = eye == Eye::kLeft ? run.quality.left : run.quality.right;
    const int most = std::max(1, *std::max_element(coverage.corners.begin(), coverage.corners.end()));
    const double cell_width = kWidth / kCoverageCols;
    const double cell_height = height / kCoverageRows;
    std::string svg = begin(kWidth, height, fill("Corners in the cells of the {} picture", {name_of(eye)}));
    for (int row = 0; row < kCoverageRows; ++row)
        for (int col = 0; col < kCoverageCols; ++col) {
            const int count = coverage.corners[static_cast<std::size_t>(row * kCoverageCols + col)];
            const double strength = count == 0 ? 1 : 0.08 + 0.62 * count / most;
            svg += fill(
                R"(<rect class="{}" x="{}" y="{}" width="{}" height="{}" fill-opacity="{}"><title>{}</title></rect>)",
                {count == 0 ? "cell none" : "cell", at(col * cell_width), at(row * cell_height), at(cell_width),
                 at(cell_height), fixed(strength, 2), count == 1 ? "1 corner" : fill("{} corners", {count})});
        }
    Dots dots;
    for (const CornerMiss& corner : corners)
        dots.add((corner.seen.x + 0.5) * kWidth / run.task.width, (corner.seen.y + 0.5) * height / run.task.height);
    return svg + dots.drawn("dots") + box(0, 0, kWidth, height, "frame") + "</svg>\n";
}

std::string distance_chart(const CalibrationRun& run)
{
    constexpr double kWidth = 1040, kTop = 34, kFoot = 150, kHeight = 196, kMargin = 46;
    const double low = std::min(run.range.near_mm, run.quality.nearest_mm);
    const double high = std::max(run.range.far_mm, run.quality.farthest_mm);
    const auto x_of = [&](double mm) { return kMargin + (mm - low) / (high - low) * (kWidth - 2 * kMargin); };
    constexpr std::array<const char*, kDistanceBins> kThirds{"near", "middle", "far"};
    const auto& boards = run.quality.boards_by_distance;
    const int most = std::max(1, *std::max_element(boards.begin(), boards.end()));
    std::string svg = begin(kWidth, kHeight, "Boards by their distance");
    for (std::size_t bin = 0; bin < boards.size(); ++bin) {
        const double step_mm = (run.range.far_mm - run.range.near_mm) / kDistanceBins;
        const double from_mm = run.range.near_mm + static_cast<double>(bin) * step_mm;
        const double x = x_of(from_mm);
        const double width = x_of(from_mm + step_mm) - x;
        const bool empty = boards[bin] == 0;
        const double height = empty ? kFoot - kTop : (kFoot - kTop) * boards[bin] / most;
        svg += box(x + 2, kFoot - height, width - 4, height, empty ? "none" : "bar");
        svg += words(x + width / 2, kFoot - height - 8, "label middle",
                     empty              ? fill("{} third: empty", {kThirds[bin]})
                     : boards[bin] == 1 ? fill("{} third: 1 board", {kThirds[bin]})
                                        : fill("{} third: {} boards", {kThirds[bin], boards[bin]}));
        svg += words(x, kFoot + 36, "label middle", fixed(from_mm, 0));
    }
    svg += words(x_of(run.range.far_mm), kFoot + 36, "label middle", fixed(run.range.far_mm, 0) + " mm");
    svg += line(kMargin / 2, kFoot, kWidth - kMargin / 2, kFoot, "axis");
    for (const calibration::ViewOutcome& view : run.calibration.views)
        if (view.used && view.shift_mm.z >= low && view.shift_mm.z <= high)
            svg += line(x_of(view.shift_mm.z), kFoot + 4, x_of(view.shift_mm.z), kFoot + 18, "tick");
    return svg + "</svg>\n";
}

double scatter_reach(std::span<const CornerMiss> misses, double rms_px)
{
    double most = 0;
    for (const CornerMiss& m : misses)
        most = std::max({most, std::abs(m.miss.x), std::abs(m.miss.y)});
    return round_up(std::max(1e-3, std::min(most, 4 * rms_px)));
}

std::string scatter_chart(std::span<const CornerMiss> misses, double rms_px, double reach)
{
    constexpr double kSide = 330, kMiddle = kSide / 2, kRadius = 140;
    const double scale = kRadius / reach;
    std::string svg = begin(kSide, kSide, "Misses of the corners around zero");
    svg += line(0, kMiddle, kSide, kMiddle, "grid") + line(kMiddle, 0, kMiddle, kSide, "grid");
    Dots dots;
    int outside = 0;
    for (const CornerMiss& m : misses) {
        if (std::abs(m.miss.x) > reach || std::abs(m.miss.y) > reach)
            ++outside;
        else
            dots.add(kMiddle + scale * m.miss.x, kMiddle + scale * m.miss.y);
    }
    svg += dots.drawn("dots eye");
    for (const double part : {0.5, 1.0}) {
        svg += fill(R"(<circle class="grid" cx="{}" cy="{}" r="{}"/>)", {at(kMiddle), at(kMiddle), at(part * kRadius)});
        svg += words(kMiddle + 4, kMiddle - part * kRadius - 4, "label", mark_of(part * reach) + " px");
    }
    svg += fill(R"(<circle class="mark" cx="{}" cy="{}" r="{}"/>)",
                {at(kMiddle), at(kMiddle), at(std::min(scale * rms_px, kRadius))});
    if (outside > 0)
        svg += words(kSide - 4, kSide - 6, "label end", fill("{} outside", {outside}));
    return svg + "</svg>\n";
}

double arrow_factor(double rms_px, int width)
{
    const double wanted = width / 60.0 / std::max(rms_px, 1e-6);
    const double above = round_up(wanted);
    return above > wanted ? round_up(0.45 * above) : above; // the step below: 5 -> 2, 2 -> 1, 1 -> 0.5
}

std::string arrow_chart(std::span<const CornerMiss> misses, int width, int height, double factor)
{
    constexpr double kWidth = 500;
    const double scale = kWidth / width;
    std::string svg = begin(kWidth, scale * height, "Misses of the corners over the picture");
    Dots feet;
    std::string shafts;
    for (const CornerMiss& m : misses) {
        const double x = scale * (m.seen.x - m.miss.x + 0.5);
        const double y = scale * (m.seen.y - m.miss.y + 0.5);
        feet.add(x, y);
        shafts += fill("M{} {}l{} {}", {at(x), at(y), at(scale * factor * m.miss.x), at(scale * factor * m.miss.y)});
    }
    svg += fill(R"(<path class="shaft eye" d="{}"/>)", {shafts}) + feet.drawn("feet eye");
    return svg + box(0, 0, kWidth, scale * height, "frame") + "</svg>\n";
}

std::string pair_bars(const CalibrationRun& run)
{
    constexpr double kWidth = 1040, kLeft = 56, kTop = 20, kFoot = 190, kHeight = 216;
    double most = 0;
    for (const SeenPair& pair : run.pairs)
        if (const auto* view = outcome_of(run, pair); view != nullptr && view->used)
            most = std::max({most, view->rms_left_px, view->rms_right_px});
    const double top = round_up(std::max(1.1 * most, 1e-3));
    const double step = (kWidth - kLeft) / static_cast<double>(std::max<std::size_t>(run.pairs.size(), 1));
    const auto y_of = [&](double px) { return kFoot - std::min(px / top, 1.0) * (kFoot - kTop); };
    std::string svg = begin(kWidth, kHeight, "Root mean square miss of each pair");
    for (const double part : {0.0, 0.5, 1.0}) {
        svg += line(kLeft, y_of(part * top), kWidth, y_of(part * top), part == 0 ? "axis" : "grid");
        svg += words(kLeft - 8, y_of(part * top) + 4, "label end", part == 0 ? "0 px" : mark_of(part * top));
    }
    for (std::size_t p = 0; p < run.pairs.size(); ++p) {
        const double x = kLeft + static_cast<double>(p) * step;
        const auto* view = outcome_of(run, run.pairs[p]);
        const double bar = std::min(0.36 * step, 26.0);
        const double middle = x + step / 2;
        std::string bars;
        for (const Eye eye : kEyes) {
            const double px = view == nullptr ? 0 : eye == Eye::kLeft ? view->rms_left_px : view->rms_right_px;
            if (!(px > 0))
                continue;
            const double y = y_of(px);
            const std::string kind = std::string("bar ") + name_of(eye) + (view->used ? "" : " dropped");
            bars += box(eye == Eye::kLeft ? middle - bar : middle, y, bar - 1, kFoot - y, kind.c_str(),
                        fill("pair {}, {}: {} px", {p + 1, name_of(eye), fixed(px, 3)}));
        }
        if (view != nullptr && std::max(view->rms_left_px, view->rms_right_px) > top)
            bars += words(middle, kTop - 6, "label middle", fixed(std::max(view->rms_left_px, view->rms_right_px), 1));
        if (bars.empty())
            bars = words(middle, kFoot - 6, "label middle", "–");
        svg += fill("<a href=\"#pair-{}\">", {p + 1}) + bars;
        if (run.pairs.size() <= 60 || p % 5 == 4)
            svg += words(middle, kFoot + 18, "label middle", std::to_string(p + 1));
        svg += "</a>";
    }
    const double mean = y_of(run.calibration.rms_px);
    return svg + line(kLeft, mean, kWidth, mean, "mark") + "</svg>\n";
}

std::string gap_histogram(const RowGaps& gaps)
{
    constexpr double kWidth = 500, kTop = 24, kFoot = 190, kHeight = 216, kMargin = 12;
    constexpr int kBins = 21;
    const double reach = round_up(std::max(1e-3, std::min(gaps.most_px, 3 * gaps.rms_px)));
    std::array<int, kBins> counts{};
    for (const double gap : gaps.gaps_px) {
        const double share = std::clamp((gap + reach) / (2 * reach), 0.0, 1.0);
        ++counts[static_cast<std::size_t>(std::min(static_cast<int>(share * kBins), kBins - 1))];
    }
    const int most = std::max(1, *std::max_element(counts.begin(), counts.end()));
    const double step = (kWidth - 2 * kMargin) / kBins;
    std::string svg = begin(kWidth, kHeight, "How often which difference of rows occurs");
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
        const double height = (kFoot - kTop) * counts[bin] / most;
        if (counts[bin] > 0)
            svg += box(kMargin + static_cast<double>(bin) * step + 1, kFoot - height, step - 2, height, "bar",
                       fill("{} corners", {counts[bin]}));
    }
    svg += line(0, kFoot, kWidth, kFoot, "axis") + line(kWidth / 2, kTop - 8, kWidth / 2, kFoot, "grid");
    for (const double part : {-1.0, -0.5, 0.0, 0.5, 1.0})
        svg += words(kWidth / 2 + part * (kWidth / 2 - kMargin), kFoot + 18,
                     part == -1  ? "label"
                     : part == 1 ? "label end"
                                 : "label middle",
                     part == 0 ? "0" : (part < 0 ? "−" : "+") + mark_of(std::abs(part) * reach) + " px");
    return svg + "</svg>\n";
}

} // namespace dicot::app
