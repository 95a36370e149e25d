// Light and sharpness of both pictures.
#include "health_judges.h"

#include "dicot/aiming/focus.h"

#include <cmath>
#include <utility>

namespace dicot::app {
namespace {

constexpr double kDark = 45, kVeryDark = 20; ///< mean luma, 0 .. 255
constexpr double kBright = 195;
constexpr double kMostSaturated = 0.02;    ///< of the pixels
constexpr double kMostLumaDifference = 16; ///< between both pictures
constexpr double kPartOfUsual = 0.6;       ///< of a focus that was better before, or is better on the other side

std::optional<double> larger(std::optional<double> a, std::optional<double> b)
{
    return a && b ? std::optional{std::max(*a, *b)} : a ? a : b;
}

void judge_light(const HealthFigures& now, HealthFlags& flags)
{
    const std::optional<double> luma = larger(now.left.luma, now.right.luma);
    if (luma && *luma < kDark)
        flags.add({"dark", *luma < kVeryDark ? Severity::kWarning : Severity::kNotice,
                   health_text("The pictures are dark: mean luma %.0f of 255.", *luma),
                   "Choose slots with more light, or light the plants; open the lens if it has an aperture."});
    const std::optional<double> saturated = larger(now.left.saturated, now.right.saturated);
    if (saturated && *saturated > kMostSaturated)
        flags.add({"overexposed", Severity::kWarning,
                   health_text("%.1f %% of a picture are overexposed: nothing is matched there.", 100 * *saturated),
                   "Shade the rig from the sun, turn it away from lamps, or choose other hours."});
    else if (luma && *luma > kBright)
        flags.add({"overexposed", Severity::kNotice,
                   health_text("The pictures are very bright: mean luma %.0f of 255.", *luma),
                   "Shade the rig from the sun, turn it away from lamps, or choose other hours."});
}

struct Blur
{
    const char* side = nullptr;
    double now = 0;
    double before = 0; ///< 0: not known, or never sharp

    bool worse_than(const Blur& other) const
    {
        if (other.side == nullptr || (before > 0) != (other.before > 0))
            return other.side == nullptr || before > 0;
        return now < other.now;
    }
};

Blur worst_blur(const HealthHistory& history, const HealthFigures& now)
{
    Blur worst;
    for (const auto& [side, which] : {std::pair{"left", &HealthFigures::left}, {"right", &HealthFigures::right}}) {
        const std::optional<double> focus = (now.*which).focus;
        if (!focus)
            continue;
        const std::optional<double> before =
            usual(history, [which = which](const HealthFigures& then) { return (then.*which).focus; });
        const Blur here{side, *focus, before && *focus < kPartOfUsual * *before ? *before : 0};
        if ((here.before > 0 || *focus < aiming::kFocusSoft) && here.worse_than(worst))
            worst = here;
    }
    return worst;
}

void judge_sharpness(const HealthHistory& history, const HealthFigures& now, HealthFlags& flags)
{
    const Blur blur = worst_blur(history, now);
    if (blur.before > 0)
        flags.add({"blurred", Severity::kWarning,
                   health_text("The %s picture is blurred: focus %.0f of 100, and %.0f is usual for it.", blur.side,
                               blur.now, blur.before),
                   "Wipe the lens (dust, dew, a web), look for fog or wind, then focus it again with dicot aim."});
    else if (blur.side != nullptr)
        flags.add({"blurred", Severity::kWarning,
                   health_text("The %s picture is out of focus: %.0f of 100, and %d is sharp.", blur.side, blur.now,
                               aiming::kFocusSharp),
                   "Focus the lens: dicot aim shows how sharp it is."});
}

void judge_difference(const HealthFigures& now, HealthFlags& flags)
{
    if (now.left.luma && now.right.luma && std::fabs(*now.left.luma - *now.right.luma) > kMostLumaDifference) {
        flags.add({"unequal", Severity::kWarning,
                   health_text("The pictures are not equally bright: mean luma %.0f left, %.0f right.", *now.left.luma,
                               *now.right.luma),
                   "Look for a shadow, a leaf or dirt before one camera; see exposure.lock, and the controls in dicot "
                   "show."});
        return;
    }
    if (!now.left.focus || !now.right.focus)
        return;
    const double least = std::min(*now.left.focus, *now.right.focus);
    const double most = std::max(*now.left.focus, *now.right.focus);
    if (least < kPartOfUsual * most)
        flags.add({"unequal", Severity::kWarning,
                   health_text("The pictures are not equally sharp: focus %.0f left, %.0f right of 100.",
                               *now.left.focus, *now.right.focus),
                   "Wipe the lens of the blurred one and focus it with dicot aim."});
}

} // namespace

void judge_pictures(const HealthHistory& history, const HealthFigures& figures, HealthFlags& flags) noexcept
{
    judge_light(figures, flags);
    judge_sharpness(history, figures, flags);
    judge_difference(figures, flags);
}

} // namespace dicot::app
