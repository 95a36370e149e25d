#include "traits_plots.h"

#include "../calibrate/report_plot.h"
#include "../calibrate/report_shapes.h"
#include "../calibrate/report_style.h"
#include "../calibrate/report_text.h"
#include "../output_folder.h"
#include "../store/shown.h"

#include "dicot/base/utc_time.h"
#include "dicot/os/output_file.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dicot::app {
namespace {

using svg::Plot;
using svg::PlotPoint;
using svg::Scale;

constexpr double kWidth = 1040, kHeight = 340;
constexpr std::size_t kMostSpreads = 80; ///< samples whose sd is drawn
constexpr double kBandSds = 2;

/// Local days or hours under the axis.
Scale time_scale(const DayCount& days, double from, double to)
{
    constexpr std::array kSteps{0.125, 0.25, 0.5, 1.0, 2.0, 7.0, 14.0, 28.0, 56.0, 112.0, 364.0};
    if (to - from < 0.25) { // one moment still needs a width
        from -= 0.25;
        to += 0.25;
    }
    double step = kSteps.back();
    for (const double one : kSteps)
        if ((to - from) / one <= 9) {
            step = one;
            break;
        }
    if (step >= 1) { // whole days
        from = std::floor(from);
        to = std::ceil(to);
    }
    Scale scale{from, to, step, "", {}};
    std::string before;
    for (double mark = std::ceil(from / step) * step; mark <= to; mark += step) {
        // Whole days of this count are local midnights but for summer time, where 23:00 of the day before is meant too.
        const std::string text =
            utc_text(days.local_us(days.utc_us(mark)) + (step >= 1 ? std::int64_t{7'200'000'000} : 0)).c_str();
        const std::string begun = text.substr(0, step >= 1 ? 4 : 10); // year or day: said where it begins
        const std::string rest = step >= 1 ? text.substr(5, 5) : text.substr(11, 5);
        scale.named.emplace_back(mark, begun == before ? rest : begun + (step >= 1 ? "-" : " ") + rest);
        before = begun;
    }
    return scale;
}

/// From 0 where nothing is far above it, for lengths and areas.
Scale value_scale(double low, double high, const std::string& unit)
{
    if (low >= 0 && low < 0.6 * high)
        low = 0;
    if (!(high > low))
        high = low + std::max(std::abs(low) * 0.1, 1.0);
    return Scale::around(low, high, 5, unit);
}

std::string digits(double value)
{
    const double size = std::abs(value);
    return fixed(value, size >= 100 ? 0 : size >= 1 ? 1 : 3);
}

/// What stands for a plot in words: the end of the curve.
std::string newest_words(const TraitSeries& series)
{
    for (auto point = series.fit.curve.rbegin(); point != series.fit.curve.rend(); ++point) {
        if (std::isnan(point->value.value))
            continue;
        const double scale = series.column->drawn_units;
        const std::string unit = *series.column->drawn_unit == 0 ? "" : std::string{" "} + series.column->drawn_unit;
        std::string text = digits(scale * point->value.value) + unit;
        if (const double rate = scale * point->rate_per_day.value; std::isfinite(rate))
            text += fill(", {}{}{} a day", {rate >= 0 ? "+" : "", digits(rate), unit});
        if (std::isfinite(point->relative_rate_per_day.value))
            text += fill(" ({} %)", {fixed(100 * point->relative_rate_per_day.value, 1)});
        return text;
    }
    return "";
}

void draw_gaps(Plot& plot, const BoardGrowth& growth, double from, double to)
{
    for (const SeriesGap& gap : growth.gaps) { // all are dated where a sample is
        const double begin = std::max(growth.days.day_of(gap.from_us), from);
        const double end = std::min(growth.days.day_of(gap.to_us), to);
        if (end > begin)
            plot.stripe(begin, end, "gap", counted(gap.slots, "slot") + ": " + shown(gap.reason));
    }
}

/// A curve and its band, interrupted where nothing is known.
void draw_curve(Plot& plot, std::span<const std::pair<double, Measured>> points, double scale)
{
    std::vector<PlotPoint> curve, low, high;
    const auto flush = [&] {
        if (curve.size() > 1) {
            plot.band(low, high, "band");
            plot.curve(curve, "trace");
        }
        for (auto* part : {&curve, &low, &high})
            part->clear();
    };
    for (const auto& [x, measured] : points) {
        if (std::isnan(measured.value)) {
            flush();
            continue;
        }
        const double value = scale * measured.value;
        const double reach = std::isfinite(measured.sd) ? scale * kBandSds * measured.sd : 0;
        curve.emplace_back(x, value);
        low.emplace_back(x, value - reach);
        high.emplace_back(x, value + reach);
    }
    flush();
}

std::string drawn_series(const BoardGrowth& growth, const TraitSeries& series, const std::string& title)
{
    const double scale = series.column->drawn_units;
    std::vector<PlotPoint> used, outliers;
    double low = 1e300, high = -1e300, from = 1e300, to = -1e300;
    for (std::size_t k = 0; k < series.samples.size(); ++k) {
        if (series.fit.samples[k].use == SampleFit::Use::kUnmeasured)
            continue;
        const GrowthSample& sample = series.samples[k];
        const bool is_used = series.fit.samples[k].use == SampleFit::Use::kUsed;
        const double value = scale * sample.measured.value;
        (is_used ? used : outliers).emplace_back(sample.day, value);
        low = std::min(low, value);
        high = std::max(high, value);
        from = std::min(from, sample.day);
        to = std::max(to, sample.day);
    }
    Plot plot(kWidth, kHeight, time_scale(growth.days, from, to), value_scale(low, high, series.column->drawn_unit),
              title);
    draw_gaps(plot, growth, from, to);
    std::vector<std::pair<double, Measured>> curve;
    for (const GrowthPoint& point : series.fit.curve)
        curve.emplace_back(point.day, point.value);
    draw_curve(plot, curve, scale);
    if (series.samples.size() <= kMostSpreads)
        for (std::size_t k = 0; k < series.samples.size(); ++k) {
            const auto& [value, sd] = series.samples[k].measured;
            if (series.fit.samples[k].use != SampleFit::Use::kUnmeasured && std::isfinite(sd))
                plot.reach(series.samples[k].day, scale * (value - sd), scale * (value + sd), "spread");
        }
    plot.dots(used, "dots sample");
    plot.rings(outliers, "hollow");
    return plot.drawn();
}

std::string drawn_daily(const TraitSeries& series, const std::string& title)
{
    const double scale = series.column->drawn_units;
    std::vector<std::pair<double, Measured>> hours;
    double reach = 1e-6;
    for (int hour = 0; hour <= GrowthFit::kHours; ++hour) {
        const Measured& at = series.fit.daily[static_cast<std::size_t>(hour % GrowthFit::kHours)];
        hours.emplace_back(hour, at);
        if (std::isfinite(at.value))
            reach = std::max(reach, scale * (std::abs(at.value) + kBandSds * at.sd));
    }
    Plot plot(kWidth, 240, Scale{0, 24, 3, "h", {}}, Scale::around(-reach, reach, 4, series.column->drawn_unit), title);
    draw_curve(plot, hours, scale);
    return plot.drawn();
}

std::string drawn_leaves(const BoardTraits& board, const BoardGrowth& growth, const PlantLife& life,
                         const std::string& title)
{
    double high = 0, from = 1e300, to = -1e300;
    std::vector<std::vector<PlotPoint>> lines;
    for (const LeafLife& leaf : life.leaves) {
        std::vector<PlotPoint>& line = lines.emplace_back();
        for (const Sighting& at : leaf.seen) {
            const SlotTraits& slot = board.slots[at.slot];
            const double area = slot.traits->leaves[at.index].area_mm2.value / 100;
            if (!is_dated(slot.row) || !std::isfinite(area))
                continue;
            line.emplace_back(growth.days.day_of(slot.row.began_us), area);
            high = std::max(high, area);
            from = std::min(from, line.back().first);
            to = std::max(to, line.back().first);
        }
    }
    if (!(high > 0))
        return "";
    Plot plot(kWidth, kHeight, time_scale(growth.days, from, to), value_scale(0, high, "cm²"), title);
    draw_gaps(plot, growth, from, to);
    for (const std::vector<PlotPoint>& line : lines) {
        if (line.size() > 1)
            plot.curve(line, "life");
        plot.dots(line, "dots sample");
    }
    return plot.drawn();
}

Status write_text(const std::string& path, const std::string& text)
{
    OutputFile file;
    TRY(file.open(path.c_str()));
    TRY(file.write(text.data(), text.size()));
    return file.commit();
}

} // namespace

std::vector<DrawnPlot> growth_plots(const BoardTraits& board, const BoardGrowth& growth)
{
    std::vector<DrawnPlot> plots;
    const auto add = [&](const PlantLife& life, const std::string& what, const std::string& title, auto&& drawn) {
        const std::string whole = shown(board.device) + ", " + shown(life.name) + ": " + title;
        std::string svg = drawn(whole);
        if (!svg.empty())
            plots.push_back(
                {board.device + "_plant" + std::to_string(life.id) + "_" + what + ".svg", whole, std::move(svg)});
    };
    for (const PlantGrowth& plant : growth.plants) {
        for (const TraitSeries& series : plant.series) {
            const std::string newest = newest_words(series);
            add(plant.life, series.column->name, series.column->words + (newest.empty() ? "" : "; at last " + newest),
                [&](const std::string& title) { return drawn_series(growth, series, title); });
            if (series.fit.daily_known)
                add(plant.life, std::string{series.column->name} + "_by_hour",
                    std::string{series.column->words} + ", what the time of day adds",
                    [&](const std::string& title) { return drawn_daily(series, title); });
        }
        add(plant.life, "leaves", fill("area of each of {} leaves", {plant.life.leaves.size()}),
            [&](const std::string& title) { return drawn_leaves(board, growth, plant.life, title); });
    }
    return plots;
}

Status write_plots(const std::string& folder, const std::vector<DrawnPlot>& plots)
{
    TRY(make_folder(folder));
    std::string page =
        fill("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
             "<meta name=\"viewport\" content=\"width=device-width\"/><title>Growth</title>"
             "<style>{}</style></head>\n<body><h1>Growth</h1>\n<p class=\"note\">Dots are snapshots, rings "
             "outliers that the curve is made without; the band is two standard deviations; shaded is "
             "where snapshots are missing (point at it for the reason).</p>\n",
             {kReportStyle});
    for (const DrawnPlot& plot : plots) {
        TRY(write_text(folder + "/" + plot.file, svg::standalone(plot.svg)));
        page += fill("<h3>{}</h3>\n<figure>{}</figure>\n", {escaped(plot.title), plot.svg});
    }
    return write_text(folder + "/index.html", page + "</body></html>\n");
}

} // namespace dicot::app
