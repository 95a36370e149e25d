#include "shot_record.h"

#include "../aim/aim_advice.h"

#include "dicot/base/utc_time.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace dicot::app {
namespace {

using nlohmann::json;

constexpr double kMostSaturated = 0.02;    ///< of the pixels
constexpr double kMostLumaDifference = 16; ///< levels between the means of both pictures
constexpr double kDarkLuma = 20;           ///< levels

double levels(std::uint32_t q8)
{
    return q8 / 256.0;
}

double share(const LumaFigures& luma)
{
    return luma.saturated_q16 / 65536.0;
}

json mode_record(const PlannedStream& stream)
{
    const CameraMode& mode = stream.mode;
    return {{"format", name_of(mode.format)},
            {"width", mode.width},
            {"height", mode.height},
            {"frames_per_s", mode.interval_100ns > 0 ? 1e7 / mode.interval_100ns : 0},
            {"alternate_setting", stream.alternate},
            {"reserved_bytes_per_s", stream.reserved_bytes_per_s}};
}

json settling_record(const SideFigures& side)
{
    const SettlingFigures& settling = side.settling;
    return {{"settled", side.settled},
            {"state", name_of(settling.state)},
            {"frames", settling.frames},
            {"seconds", static_cast<double>(settling.elapsed_us) * 1e-6},
            {"mean_luma", levels(settling.mean_luma_q8)},
            {"slope_levels_per_frame", settling.slope_q16 / 65536.0}};
}

json ladder_record(const LadderFigures& ladder)
{
    return {{"restarts", ladder.shakes[0]},
            {"reopens", ladder.shakes[1]},
            {"port_resets", ladder.shakes[2]},
            {"recoveries", ladder.recoveries},
            {"gave_up", ladder.gave_up},
            {"first_reason", ladder.first_reason.text},
            {"last_reason", ladder.last_reason.text}};
}

json side_record(const Camera& camera, const SideFigures& side, const PlannedStream& stream)
{
    const CameraIdentity& who = camera.identity();
    return {{"port", who.port.text},
            {"name", who.name.text},
            {"serial", who.serial.text},
            {"vendor", who.vendor},
            {"product", who.product},
            {"driver", who.driver},
            {"mode", mode_record(stream)},
            {"frames",
             {{"whole", side.whole},
              {"torn", side.torn},
              {"cancelled", side.cancelled},
              {"warming_up", side.warming_up},
              {"lost", side.lost},
              {"last_flaw", side.last_flaw.text}}},
            {"warm_up", settling_record(side)},
            {"ladder", ladder_record(side.ladder)}};
}

json control_side(const ControlSide& side)
{
    json record = {{"outcome", name_of(side.outcome)}};
    if (side.outcome == ControlOutcome::kSet || side.outcome == ControlOutcome::kOther)
        record["value"] = side.value;
    return record;
}

json lock_record(const std::optional<ExposureLock>& lock)
{
    if (!lock)
        return {};
    json controls = json::object();
    for (const LockedControl& one : lock->all())
        if (one.lead.outcome != ControlOutcome::kAbsent || one.other.outcome != ControlOutcome::kAbsent)
            controls[name_of(one.id)] = {{"left", control_side(one.lead)}, {"right", control_side(one.other)}};
    return {{"differing", lock->differing()}, {"controls", controls}};
}

const char* words_of(Together together)
{
    switch (together) {
    case Together::kAtOnce:
        return "at once";
    case Together::kOneAfterTheOther:
        return "one after the other";
    case Together::kNotAtAll:
        break;
    }
    return "not at all";
}

json average_record(const AverageFigures& average)
{
    return {{"pictures", average.pictures},
            {"moving_pixels", average.moving_pixels},
            {"moving_threshold_levels", average.threshold},
            {"too_much_moved", average.whole}};
}

json views_record(const std::optional<aiming::Views>& views)
{
    if (!views)
        return {};
    const auto known = [](bool is_known, double value) { return is_known ? json(value) : json(); };
    const bool matched = views->known();
    return {{"order", name_of(views->order)},
            {"matches", views->matches},
            {"shift_px", known(matched, views->shift_px)},
            {"vertical_px", known(matched, views->vertical_px)},
            {"roll_deg", known(matched && roll_known(*views), views->roll_deg)},
            {"overlap_percent", known(matched, views->overlap_percent)}};
}

} // namespace

json cameras_record(RigStream& rig)
{
    const StereoFigures& figures = rig.cameras().figures();
    const BandwidthPlan& plan = figures.plan;
    return {{"plan", {{"together", words_of(plan.together)}, {"why", plan.why}, {"refused", figures.refused}}},
            {"left", side_record(rig.left(), figures.left, plan.left)},
            {"right", side_record(rig.right(), figures.right, plan.right)},
            {"exposure_lock", lock_record(figures.lock)}};
}

json shot_record(const ShotFigures& figures)
{
    const BurstFigures& burst = figures.burst;
    return {{"time", utc_text(figures.taken_us).view()},
            {"skew_us", burst.skew_us},
            {"least_skew_us", burst.least_skew_us},
            {"pairs", burst.pairs},
            {"pairs_used", burst.used},
            {"pairs_beyond_skew", burst.beyond_skew},
            {"pairs_undecodable", burst.undecodable},
            {"average", {{"left", average_record(burst.left)}, {"right", average_record(burst.right)}}},
            {"mean_luma", {{"left", levels(figures.left.mean_q8)}, {"right", levels(figures.right.mean_q8)}}},
            {"luma_difference", levels(figures.right.mean_q8) - levels(figures.left.mean_q8)},
            {"saturated_share", {{"left", share(figures.left)}, {"right", share(figures.right)}}},
            {"views", views_record(figures.views)},
            {"wait_s", figures.wait_s},
            {"cpu_s", figures.cpu_s}};
}

std::vector<std::string> shot_warnings(RigStream& rig, const ShotFigures& figures)
{
    std::vector<std::string> warnings;
    if (figures.views && figures.views->order == aiming::Order::kSwapped)
        warnings.emplace_back(
            "the left and the right camera seem to be swapped: exchange cameras.left and cameras.right, or "
            "their plugs");
    const double left = levels(figures.left.mean_q8);
    const double right = levels(figures.right.mean_q8);
    char text[160];
    if (std::max(left, right) < kDarkLuma) {
        std::snprintf(text, sizeof text, "it is dark: mean luma %.0f and %.0f of 255", left, right);
        warnings.emplace_back(text);
    } else if (std::abs(left - right) > kMostLumaDifference) {
        std::snprintf(text, sizeof text, "the pictures are not equally bright: mean luma %.0f left, %.0f right", left,
                      right);
        warnings.emplace_back(text);
    }
    if (std::max(share(figures.left), share(figures.right)) > kMostSaturated) {
        std::snprintf(text, sizeof text, "%.1f %% of the left and %.1f %% of the right picture are overexposed",
                      100 * share(figures.left), 100 * share(figures.right));
        warnings.emplace_back(text);
    }
    const StereoFigures& cameras = rig.cameras().figures();
    for (const auto& [side, ladder] : {std::pair{"left", &cameras.left.ladder}, {"right", &cameras.right.ladder}})
        if (ladder->gave_up)
            warnings.push_back(std::string("the ") + side + " camera stopped and did not come back");
    if (!cameras.left.settled || !cameras.right.settled)
        warnings.emplace_back("the brightness did not become steady within exposure.warm_up_s");
    if (cameras.lock && cameras.lock->differing() > 0) {
        std::snprintf(text, sizeof text, "%d controls differ between the cameras", cameras.lock->differing());
        warnings.emplace_back(text);
    }
    return warnings;
}

} // namespace dicot::app
