#include "aim_text.h"

#include "aim_advice.h"

#include <cstdarg>
#include <cstdio>

namespace dicot::app {

std::string text_of(const char* format, ...)
{
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

namespace {

std::string side_in_line(const char* name, const AimSide& side)
{
    const std::string focus = side.focus.known() ? std::to_string(side.focus.whole) : "?";
    const std::string best = side.best_focus < 0 ? "?" : std::to_string(side.best_focus);
    const std::string rate = side.frames_per_s > 0 ? text_of("%.1f", side.frames_per_s) : "?";
    return text_of("%s: focus %s (best %s), luma %d, %.1f %% saturated, %s frames/s", name, focus.c_str(), best.c_str(),
                   side.light.mean_luma, side.light.saturated_percent, rate.c_str());
}

std::string views_in_line(const aiming::Views& views)
{
    if (!views.known())
        return text_of("%d matches, too few", views.matches);
    const std::string roll = roll_known(views) ? text_of("%+.1f degrees", views.roll_deg) : "not known";
    return text_of("overlap %d %%, vertical %+.0f px, roll %s", views.overlap_percent, views.vertical_px, roll.c_str());
}

} // namespace

std::string aim_line(const AimMoment& now)
{
    std::string line = text_of("%.0f s | ", now.elapsed_s) + side_in_line("left", now.left) + " | " +
                       side_in_line("right", now.right) + " | " + views_in_line(now.views);
    if (!now.one_at_a_time)
        line += text_of(", skew %.1f ms", static_cast<double>(now.skew_us) / 1000);
    const std::vector<std::string> advice = aim_advice(now);
    return line + " | " + (advice.empty() ? "all is well" : advice.front());
}

std::string aim_summary(const AimMoment& last, bool advice)
{
    if (last.pairs == 0)
        return "no pair was seen\n";
    const auto focus = [](const AimSide& side) {
        return side.best_focus < 0 ? std::string{"not known"} : std::to_string(side.best_focus);
    };
    std::string text = text_of("%llu pairs in %.0f s, best focus %s and %s, torn %llu and %llu\n",
                               static_cast<unsigned long long>(last.pairs), last.elapsed_s, focus(last.left).c_str(),
                               focus(last.right).c_str(), static_cast<unsigned long long>(last.left.torn),
                               static_cast<unsigned long long>(last.right.torn));
    const std::vector<std::string> sentences = aim_advice(last);
    if (sentences.empty())
        return text + "all is well; next comes dicot calibrate --live\n";
    if (advice)
        for (const std::string& sentence : sentences)
            text += "to do: " + sentence + "\n";
    return text;
}

} // namespace dicot::app
