#include "depth_report.h"

#include "../calibrate/report_plot.h"
#include "../calibrate/report_shapes.h"
#include "../calibrate/report_style.h"
#include "../calibrate/report_text.h"
#include "../output_folder.h"
#include "depth_words.h"

#include "dicot/os/output_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <unistd.h>

namespace dicot::app {
namespace {

constexpr int kCurvePoints = 60;

Status write_text(const std::string& path, const std::string& text)
{
    OutputFile file;
    TRY(file.open(path.c_str()));
    TRY(file.write(text.data(), text.size()));
    return file.commit();
}

std::string table_of(const DepthRun& run)
{
    std::string html =
        "<table><thead><tr><th>target</th><th>true</th><th>measured</th><th>error</th><th>eq. 21</th>"
        "<th>half of the pixels within</th><th>95 of 100 within</th><th>with a value</th></tr></thead><tbody>\n";
    const auto mm = [](double value, int decimals) {
        return fill("<td class=\"plain\">{} mm</td>", {fixed(value, decimals)});
    };
    for (const DepthReading& r : run.readings) {
        html += fill("<tr><th scope=\"row\">{}</th>", {escaped(r.target.name)}) + mm(r.target.distance_mm, 1);
        if (r.measured())
            html += mm(r.face.measured_mm, 2) +
                    fill("<td class=\"number\">{}{} mm</td>",
                         {r.face.error_mm < 0 ? "−" : "+", fixed(std::abs(r.face.error_mm), 2)}) +
                    fill("<td class=\"plain\">± {} mm{}</td>",
                         {fixed(r.bound_mm, 2), r.within_bound() ? "" : " <b>exceeded</b>"}) +
                    mm(r.face.spread_mm, 2) + mm(r.face.point_mm, 2) +
                    fill("<td class=\"plain\">{} %</td>", {fixed(100 * r.face.valued_share(), 1)});
        else
            html += fill("<td colspan=\"6\">no depth: {}</td>", {escaped(r.lost)});
        html += "</tr>\n";
    }
    return html + "</tbody></table>\n";
}

std::string tile(const std::string& over, const std::string& figure, const std::string& unit, const std::string& under)
{
    return fill("<div class=\"tile\"><span>{}</span><b>{} <small>{}</small></b><span>{}</span></div>\n",
                {over, figure, unit, under});
}

std::string tiles_of(const DepthRun& run)
{
    std::vector<double> sizes;
    double pixels = 0, valued = 0;
    for (const DepthReading& r : run.readings) {
        if (r.measured())
            sizes.push_back(std::abs(r.face.error_mm));
        pixels += r.face.pixels;
        valued += r.face.valued;
    }
    std::ranges::sort(sizes);
    const DepthReading* worst = run.worst();
    return "<div class=\"tiles\">\n" +
           tile("largest error", fixed(std::abs(worst->face.error_mm), 2), "mm",
                fill("at {} mm, where eq. 21 allows ± {} mm",
                     {fixed(worst->target.distance_mm, 0), fixed(worst->bound_mm, 2)})) +
           tile("half of the targets are off by less than", fixed(sizes[sizes.size() / 2], 2), "mm",
                fill("{} of {} targets stay under the bound", {run.within_bound(), run.measured()})) +
           tile("pixels with a value", fixed(pixels > 0 ? 100 * valued / pixels : 0, 1), "%",
                fill("of {} on the targets", {static_cast<long long>(pixels)})) +
           "</div>\n";
}

std::string notes_of(const DepthRun& run, const DepthWords& words)
{
    std::string html = fill(
        "<h2 id=\"how\">How it was measured</h2>\n<ul>\n<li>Both pictures were rectified with {} ({}) and matched by "
        "method {}; the search was open from {} to {} mm, whatever the target's distance.</li>\n"
        "<li>A target's depth is the median over its inner part, along the optical axis of the left camera.</li>\n"
        "<li>Bound: Z² / (f B) · {} px with f = {} px and B = {} mm of the rectified pair: half a step of whole "
        "disparities (eq. 21).</li>\n",
        {escaped(words.rig), run.rig_id.empty() ? "no id" : fill("<code>{}</code>", {escaped(run.rig_id)}),
         escaped(words.match.method), fixed(run.range.near_mm, 0), fixed(run.range.far_mm, 0), fixed(kStepPx, 1),
         fixed(run.rig.focal_px, 2), fixed(run.rig.baseline_mm, 3)});
    for (const LonePicture& lone : run.alone)
        html += fill("<li>Left out: {}: {}</li>\n", {escaped(lone.name), escaped(lone.reason)});
    return html + "</ul>\n";
}

} // namespace

std::string depth_chart(const DepthRun& run)
{
    std::vector<double> distances;
    double most = 0;
    for (const DepthReading& r : run.readings) {
        distances.push_back(r.target.distance_mm);
        most = std::max(most, r.bound_mm);
        if (r.measured()) // a mismatched target must not squeeze all others
            most = std::max(most, std::min(std::abs(r.face.error_mm) + r.face.spread_mm, 3 * r.bound_mm));
    }
    const double from = distances.front(), to = std::max(distances.back(), from + 1);
    svg::Plot plot(1040, 420, svg::Scale::around(from, to, 10, "mm"), svg::Scale::around(-most, most, 8, "mm"),
                   "Error of the measured depth over the distance, and the bound of equation 21");
    std::vector<svg::PlotPoint> lower, upper, dots;
    for (int k = 0; k <= kCurvePoints; ++k) {
        const double z = from + (to - from) * k / kCurvePoints;
        const double bound = depth_bound_mm(run.rig, z, kStepPx);
        lower.emplace_back(z, -bound);
        upper.emplace_back(z, bound);
    }
    plot.band(lower, upper, "band");
    plot.curve(lower, "mark");
    plot.curve(upper, "mark");
    for (const DepthReading& r : run.readings)
        if (r.measured()) {
            plot.reach(r.target.distance_mm, r.face.error_mm - r.face.spread_mm, r.face.error_mm + r.face.spread_mm,
                       "reach");
            dots.emplace_back(r.target.distance_mm, r.face.error_mm);
        }
    plot.dots(dots, "dots trace");
    return plot.drawn();
}

Status write_depth_report(const DepthRun& run, const DepthWords& words, const std::string& folder)
{
    TRY(make_folder(folder));
    const std::string page = folder + "/index.html";
    // The page of an earlier run would stand beside the plot of this one.
    if (::unlink(page.c_str()) != 0 && errno != ENOENT)
        return failure(Fault::kCannotCreate, "%s: cannot be replaced (%s): name another folder", page.c_str(),
                       std::strerror(errno));
    const std::string chart = depth_chart(run);
    TRY(write_text(folder + "/accuracy.svg", svg::standalone(chart)));
    TRY(write_text(folder + "/accuracy.csv", as_csv(run)));
    const bool good = run.within_bound() == run.measured();
    const std::string html =
        fill("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
             "<title>Depth accuracy</title>\n<style>{}</style></head>\n<body>\n"
             "<p class=\"over\">Depth of targets at known distances{}</p>\n"
             "<div class=\"verdict {}\"><h1>{}</h1><p>{}</p></div>\n{}"
             "<figure>\n{}<figcaption>Measured minus true distance. A dot is the median of a target, its stroke holds "
             "half of the pixels; dashed: the bound of eq. 21. The same as <a href=\"accuracy.svg\">accuracy.svg</a>, "
             "and as numbers: <a href=\"accuracy.csv\">accuracy.csv</a>.</figcaption></figure>\n"
             "<h2 id=\"cause\">Where the error comes from</h2>\n<p>{}</p>\n"
             "<h2 id=\"targets\">Targets</h2>\n{}{}</body></html>\n",
             {kReportStyle, run.rig_id.empty() ? "" : " · " + escaped(run.rig_id), good ? "good" : "redo",
              good ? "Under the bound" : "Beyond the bound", escaped(summary_of(run)), tiles_of(run), chart,
              escaped(sentence_of(run.trend, run.rig.focal_px)), table_of(run), notes_of(run, words)});
    return write_text(page, html);
}

} // namespace dicot::app
