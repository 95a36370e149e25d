// The figures for a program.
#include "aim_advice.h"
#include "aim_text.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace dicot::app {
namespace {

using nlohmann::json;

double rounded(double value, double steps)
{
    return std::round(value * steps) / steps;
}

json focus_json(int figure)
{
    return figure == aiming::Focus::kUnknown ? json(nullptr) : json(figure);
}

json as_json(const AimSide& side)
{
    json regions = json::array();
    for (const int figure : side.focus.region)
        regions.push_back(focus_json(figure));
    return {{"focus", focus_json(side.focus.whole)},
            {"focus_best", focus_json(side.best_focus)},
            {"focus_regions", regions},
            {"luma_mean", side.light.mean_luma},
            {"saturated_percent", rounded(side.light.saturated_percent, 100)},
            {"frames_per_s", side.frames_per_s > 0 ? json(rounded(side.frames_per_s, 10)) : json(nullptr)},
            {"torn", side.torn},
            {"lost", side.lost}};
}

json as_json(const aiming::Views& views)
{
    const auto px = [&](double value) { return views.known() ? json(rounded(value, 100)) : json(nullptr); };
    return {{"matches", views.matches},
            {"patches", views.patches},
            {"shift_px", px(views.shift_px)},
            {"shift_low_px", px(views.shift_low_px)},
            {"shift_high_px", px(views.shift_high_px)},
            {"vertical_px", px(views.vertical_px)},
            {"roll_deg", roll_known(views) ? json(rounded(views.roll_deg, 100)) : json(nullptr)},
            {"overlap_percent", views.known() ? json(views.overlap_percent) : json(nullptr)},
            {"order", name_of(views.order)}};
}

} // namespace

std::string aim_json(const AimMoment& now)
{
    const json object = {{"elapsed_s", rounded(now.elapsed_s, 1000)},
                         {"width", now.width},
                         {"height", now.height},
                         {"pairs", now.pairs},
                         {"left", as_json(now.left)},
                         {"right", as_json(now.right)},
                         {"views", as_json(now.views)},
                         {"skew_us", now.one_at_a_time ? json(nullptr) : json(now.skew_us)},
                         {"advice", aim_advice(now)}};
    return object.dump();
}

std::string aim_summary_json(const AimMoment& last)
{
    const auto side = [](const AimSide& seen) {
        return json{{"focus_best", focus_json(seen.best_focus)}, {"torn", seen.torn}, {"lost", seen.lost}};
    };
    const json summary = {{"elapsed_s", rounded(last.elapsed_s, 1000)},
                          {"pairs", last.pairs},
                          {"left", side(last.left)},
                          {"right", side(last.right)},
                          {"advice", last.pairs > 0 ? json(aim_advice(last)) : json::array()}};
    return json{{"summary", summary}}.dump();
}

} // namespace dicot::app
