// How both cameras stand to each other, how they work, and what becomes of their pictures.
#include "health_judges.h"

#include <cmath>

namespace dicot::app {
namespace {

constexpr double kMostResidualPx = 0.25;
constexpr double kMostCornerPx = 0.5; ///< what a roll or a focal length adds towards the corners
constexpr std::size_t kFewestReferences = 3;
constexpr double kPartOfMostSkew = 0.5;
constexpr double kPartOfUsualFill = 0.6;
constexpr int kMissesInARow = 2, kManyMissesInARow = 6;

constexpr char kCalibrate[] =
    "See that both cameras are tight on their mount and nothing was bumped; then calibrate again: dicot calibrate.";

std::optional<double> first_residual(const HealthHistory& history, const HealthFigures& now)
{
    const std::span<const double> all = history.reference_px();
    if (!(history.reference_id() == now.calibration_id) || all.size() < kFewestReferences)
        return std::nullopt;
    std::array<double, HealthHistory::kReference> sorted{};
    std::copy(all.begin(), all.end(), sorted.begin());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(all.size()));
    return *middle;
}

void judge_drift(const HealthHistory& history, const HealthFigures& now, HealthFlags& flags)
{
    if (!now.epipolar)
        return;
    const HealthEpipolar& rows = *now.epipolar;
    const std::optional<double> first = first_residual(history, now);
    const double moved = first ? rows.median_px - *first : 0;
    const double worst = std::max(std::fabs(rows.median_px), std::fabs(moved));
    if (first && std::fabs(moved) > kMostResidualPx)
        flags.add({"drift", worst > 4 * kMostResidualPx ? Severity::kAlarm : Severity::kWarning,
                   health_text("The calibration has drifted: rows are %.2f px apart, and were %.2f px after it was "
                               "made.",
                               rows.median_px, *first),
                   kCalibrate});
    else if (std::fabs(rows.median_px) > kMostResidualPx)
        flags.add(
            {"drift", worst > 4 * kMostResidualPx ? Severity::kAlarm : Severity::kWarning,
             health_text("The calibration does not fit: rows are %.2f px apart, and 0.25 px is the most that does.",
                         rows.median_px),
             kCalibrate});
    else if (rows.corner_px > kMostCornerPx)
        flags.add({"drift", Severity::kWarning,
                   health_text("Rows are %.2f px apart in a corner: the right camera is rolled by %.2f degrees or sees "
                               "things %.2f %% larger.",
                               rows.corner_px, rows.roll_deg, rows.height_ppm * 1e-4),
                   kCalibrate});
}

void judge_skew(const HealthFigures& now, HealthFlags& flags)
{
    if (now.skew_ms && now.most_skew_ms && std::fabs(*now.skew_ms) > kPartOfMostSkew * *now.most_skew_ms)
        flags.add({"skew", Severity::kWarning,
                   health_text("The pictures were taken %.1f ms apart, and %.1f ms is the most allowed: leaves that "
                               "move are misplaced.",
                               std::fabs(*now.skew_ms), *now.most_skew_ms),
                   "Give both cameras the same mode and the same hub, and raise burst.frames; in wind choose a calmer "
                   "hour."});
}

void judge_fill(const HealthHistory& history, const HealthFigures& now, HealthFlags& flags)
{
    const std::optional<double> before = usual(history, [](const HealthFigures& then) { return then.fill; });
    if (now.fill && before && *now.fill < kPartOfUsualFill * *before)
        flags.add(
            {"few_points", Severity::kWarning,
             health_text("Few points: %.0f %% of the picture were matched within the range, and %.0f %% is usual.",
                         100 * *now.fill, 100 * *before),
             "Look at left.jpg: something may hang before a lens, the scene may have changed, or the rig was "
             "moved."});
}

void judge_cameras(const HealthHistory& history, const HealthFigures& now, HealthFlags& flags)
{
    constexpr char kAction[] =
        "Check the cameras' plugs, cables and their supply (a hub of its own helps): dicot probe "
        "tells what is there, dicot list --missed why.";
    const int misses = now.done ? 0 : history.misses_in_a_row() + 1;
    if (misses >= kMissesInARow)
        flags.add({"missed", misses >= kManyMissesInARow ? Severity::kAlarm : Severity::kWarning,
                   health_text("%d slots in a row were missed.", misses),
                   "See what dicot list --missed says of them: each has its reason."});
    else if (now.gave_up)
        flags.add({"cameras", Severity::kWarning, "A camera stopped and did not come back.", kAction});
    else if (now.shakes > 0)
        flags.add({"cameras", Severity::kNotice,
                   health_text("A camera had to be started again: %d times in this slot.", now.shakes), kAction});
}

} // namespace

void judge_rig(const HealthHistory& history, const HealthFigures& figures, HealthFlags& flags) noexcept
{
    judge_drift(history, figures, flags);
    judge_skew(figures, flags);
    judge_fill(history, figures, flags);
    judge_cameras(history, figures, flags);
}

} // namespace dicot::app
