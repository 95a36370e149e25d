#include "aim_advice.h"

#include "aim_text.h"

#include <cmath>

namespace dicot::app {
namespace {

using aiming::Order;
using aiming::Views;

bool too_dark(const Light& light)
{
    return light.mean_luma < kLeastLuma;
}

bool too_bright(const Light& light)
{
    return light.mean_luma > kMostLuma || light.saturated_percent > kMostSaturatedPercent;
}

void advise_light(std::vector<std::string>& advice, const char* side, const Light& light)
{
    if (too_dark(light))
        advice.push_back(
            text_of("%s: too dark (mean %d of 255): give more light, or a longer exposure", side, light.mean_luma));
    else if (too_bright(light))
        advice.push_back(text_of("%s: too bright (mean %d of 255, %.0f %% saturated): give less light, or a shorter "
                                 "exposure",
                                 side, light.mean_luma, light.saturated_percent));
}

/// The figure also moves with what is in view.
constexpr int kWasBetter = 10;

void advise_focus(std::vector<std::string>& advice, const char* side, const AimSide& seen)
{
    if (!seen.focus.known())
        return;
    if (seen.best_focus >= seen.focus.whole + kWasBetter)
        advice.push_back(
            text_of("%s: was sharper (%d, now %d): turn its lens back", side, seen.best_focus, seen.focus.whole));
    else if (seen.focus.whole < aiming::kFocusSharp)
        advice.push_back(text_of("%s: not sharp (%d; %d is): turn its lens until the figure is highest", side,
                                 seen.focus.whole, aiming::kFocusSharp));
}

void advise_order(std::vector<std::string>& advice, const Views& views)
{
    if (views.order == Order::kSwapped)
        advice.push_back("left and right are swapped: exchange cameras.left and cameras.right in the configuration, "
                         "or the cameras");
    else if (views.order == Order::kNotKnown)
        advice.push_back("whether left is left cannot be told: set the cameras parallel, and put something near into "
                         "the view of both");
}

void advise_pose(std::vector<std::string>& advice, const AimMoment& now)
{
    const Views& views = now.views;
    if (roll_known(views) && std::fabs(views.roll_deg) >= kMostRollDeg)
        advice.push_back(text_of("turn the right camera %.1f degrees %s, seen from behind", std::fabs(views.roll_deg),
                                 views.roll_deg > 0 ? "counter-clockwise" : "clockwise"));
    if (std::fabs(views.vertical_px) > kMostVerticalShare * now.height)
        advice.push_back(text_of("tilt the right camera %s: it shows everything %.0f px too %s",
                                 views.vertical_px > 0 ? "down" : "up", std::fabs(views.vertical_px),
                                 views.vertical_px > 0 ? "low" : "high"));
    if (views.overlap_percent >= kLeastOverlapPercent)
        return;
    const bool towards = views.order == Order::kSwapped ? views.shift_px > 0 : views.shift_px < 0;
    advice.push_back(text_of("both pictures share only %d %%: %s", views.overlap_percent,
                             towards ? "the cameras are turned towards each other, set them parallel"
                                     : "set the cameras parallel and closer together, or further from the plants"));
}

void advise_transport(std::vector<std::string>& advice, const char* side, const AimSide& seen, std::uint64_t pairs)
{
    if (seen.torn * 100 > pairs)
        advice.push_back(text_of("%s: %llu of its frames came torn: look at its cable and its USB port", side,
                                 static_cast<unsigned long long>(seen.torn)));
}

} // namespace

const char* focus_word(const aiming::Focus& focus) noexcept
{
    if (!focus.known())
        return "not known";
    return focus.whole >= aiming::kFocusSharp ? "sharp" : focus.whole >= aiming::kFocusSoft ? "soft" : "blurred";
}

const char* light_word(const Light& light) noexcept
{
    return too_dark(light) ? "too dark" : too_bright(light) ? "too bright" : "good";
}

bool roll_known(const aiming::Views& views) noexcept
{
    return views.matches >= kMatchesForRoll;
}

std::vector<std::string> aim_advice(const AimMoment& now)
{
    std::vector<std::string> advice;
    if (now.views.order == Order::kSwapped)
        advise_order(advice, now.views);
    advise_light(advice, "left", now.left.light);
    advise_light(advice, "right", now.right.light);
    advise_focus(advice, "left", now.left);
    advise_focus(advice, "right", now.right);
    if (now.views.known()) {
        advise_pose(advice, now);
        if (now.views.order == Order::kNotKnown)
            advise_order(advice, now.views);
    } else if (advice.empty()) {
        advice.push_back("the cameras see too little in common: point both at the same plants");
    }
    if (!now.one_at_a_time && std::fabs(static_cast<double>(now.skew_us)) > now.most_skew_ms * 1000)
        advice.push_back(text_of("the pictures of a pair are %.1f ms apart, and snapshots accept %g: leaves move in "
                                 "between",
                                 std::fabs(static_cast<double>(now.skew_us)) / 1000, now.most_skew_ms));
    advise_transport(advice, "left", now.left, now.pairs);
    advise_transport(advice, "right", now.right, now.pairs);
    return advice;
}

} // namespace dicot::app
