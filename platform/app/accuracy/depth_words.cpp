#include "depth_words.h"

#include "../calibrate/report_text.h"
#include "../traits/csv_cells.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace dicot::app {
namespace {

constexpr double kPaperMm = 800; // up to where the paper promises 5 mm

const char* name_of(Trend trend)
{
    switch (trend) {
    case Trend::kTooFew:
        return "too few";
    case Trend::kNone:
        return "none";
    case Trend::kSame:
        return "constant";
    case Trend::kScale:
        return "distance";
    case Trend::kSquare:
        return "square";
    case Trend::kWhole:
        return "whole pixels";
    }
    return "";
}

std::string worst_words(const DepthReading& worst)
{
    return fill("{} mm at {} mm", {fixed(std::abs(worst.face.error_mm), 2), fixed(worst.target.distance_mm, 0)});
}

} // namespace

std::string summary_of(const DepthRun& run)
{
    const DepthReading* near = run.worst(kPaperMm);
    const DepthReading* all = run.worst();
    std::string text;
    if (near != nullptr && near != all)
        text = fill("Largest error up to {} mm: {}; of all: {}.",
                    {fixed(kPaperMm, 0), worst_words(*near), worst_words(*all)});
    else if (all != nullptr)
        text = fill("Largest error: {}.", {worst_words(*all)});
    const int beyond = run.measured() - run.within_bound();
    text += beyond == 0 ? fill(" All {} stay under the bound of eq. 21.", {run.measured()})
                        : fill(" Beyond the bound of eq. 21: {} of {}.", {beyond, run.measured()});
    return text;
}

void print_run(const DepthRun& run, const DepthWords& words)
{
    std::size_t widest = 6;
    for (const DepthReading& r : run.readings)
        widest = std::max(widest, r.target.name.size());
    const int column = static_cast<int>(std::min<std::size_t>(widest, 50));
    std::printf("%-*s   true mm  measured   error  eq. 21   half within  95 %% within  with value\n", column, "target");
    for (const DepthReading& r : run.readings) {
        if (!r.measured()) {
            std::printf("%-*s  %8.1f  no depth: %s\n", column, r.target.name.c_str(), r.target.distance_mm,
                        r.lost.c_str());
            continue;
        }
        std::printf("%-*s  %8.1f %9.2f %+7.2f %7.2f %s %9.2f mm %9.2f mm %9.1f %%\n", column, r.target.name.c_str(),
                    r.target.distance_mm, r.face.measured_mm, r.face.error_mm, r.bound_mm, r.within_bound() ? " " : "!",
                    r.face.spread_mm, r.face.point_mm, 100 * r.face.valued_share());
    }
    for (const LonePicture& lone : run.alone)
        std::printf("%-*s   left out: %s\n", column, lone.name.c_str(), lone.reason.c_str());
    std::printf("\n%s\n%s\n", summary_of(run).c_str(), sentence_of(run.trend, run.rig.focal_px).c_str());
    std::printf(
        "%d of %zu targets in %.1f s, method %s, search %.0f to %.0f mm; focal length %.1f px, baseline %.2f mm\n",
        run.measured(), run.readings.size(), run.seconds, words.match.method.c_str(), run.range.near_mm,
        run.range.far_mm, run.rig.focal_px, run.rig.baseline_mm);
}

nlohmann::json as_json(const DepthRun& run, const DepthWords& words)
{
    using nlohmann::json;
    json targets = json::array();
    for (const DepthReading& r : run.readings) {
        json target = {{"name", r.target.name},        {"left", r.target.left_path},
                       {"right", r.target.right_path}, {"distance_mm", r.target.distance_mm},
                       {"bound_mm", r.bound_mm},       {"measured_mm", nullptr},
                       {"error_mm", nullptr}};
        if (r.measured()) {
            target["measured_mm"] = r.face.measured_mm;
            target["error_mm"] = r.face.error_mm;
            target["spread_mm"] = r.face.spread_mm;
            target["point_95_mm"] = r.face.point_mm;
            target["pixels"] = r.face.pixels;
            target["density"] = r.face.valued_share();
            target["under_bound"] = r.within_bound();
        } else {
            target["reason"] = r.lost;
        }
        targets.push_back(target);
    }
    json alone = json::array();
    for (const LonePicture& lone : run.alone)
        alone.push_back({{"name", lone.name}, {"reason", lone.reason}});
    const auto worst = [](const DepthReading* r) { return r == nullptr ? json() : json(std::abs(r->face.error_mm)); };
    return {{"rig", words.rig},
            {"calibration_id", run.rig_id},
            {"table", run.source.empty() ? json() : json(run.source)},
            {"method", words.match.method},
            {"focal_px", run.rig.focal_px},
            {"baseline_mm", run.rig.baseline_mm},
            {"near_mm", run.range.near_mm},
            {"far_mm", run.range.far_mm},
            {"bound_step_px", kStepPx},
            {"targets", targets},
            {"left_out", alone},
            {"measured", run.measured()},
            {"under_bound", run.within_bound()},
            {"worst_error_mm", worst(run.worst())},
            {"worst_error_to_800_mm", worst(run.worst(kPaperMm))},
            {"trend",
             {{"cause", name_of(run.trend.trend)},
              {"amount", run.trend.amount},
              {"explained", run.trend.explained},
              {"rest_px", run.trend.left_px},
              {"words", sentence_of(run.trend, run.rig.focal_px)}}},
            {"seconds", run.seconds}};
}

std::string as_csv(const DepthRun& run)
{
    std::string text = "name,distance_mm,measured_mm,error_mm,bound_mm,spread_mm,point_95_mm,pixels,density\n";
    for (const DepthReading& r : run.readings) {
        text += csv_cell(r.target.name) + "," + fixed(r.target.distance_mm, 3) + ",";
        if (r.measured())
            text += fill("{},{},{},{},{},{},{}\n",
                         {fixed(r.face.measured_mm, 3), fixed(r.face.error_mm, 3), fixed(r.bound_mm, 3),
                          fixed(r.face.spread_mm, 3), fixed(r.face.point_mm, 3), r.face.pixels,
                          fixed(r.face.valued_share(), 4)});
        else
            text += fill(",,{},,,,\n", {fixed(r.bound_mm, 3)});
    }
    return text;
}

} // namespace dicot::app
