// The card, the clock and the temperature of the board.
#include "health_judges.h"

namespace dicot::app {
namespace {

constexpr double kFewDays = 14, kVeryFewDays = 3;
constexpr double kLeastRoomMib = 64;
constexpr double kMostClockErrorS = 1;
constexpr double kHot = 80, kVeryHot = 90; ///< degrees Celsius: where boards begin to slow down
constexpr double kWarm = 55, kWarmer = 15; ///< so much, and so much more than usual

void judge_card(const HealthCard& card, HealthFlags& flags)
{
    constexpr char kRoom[] =
        "Copy the snapshots to a host, let dicot prune delete old ones (output.prune), or put in a larger card.";
    if (card.room_mib && *card.room_mib < kLeastRoomMib)
        flags.add({"card", Severity::kAlarm,
                   health_text("The card is nearly full: %.0f MiB are left beside the reserve.", *card.room_mib),
                   kRoom});
    else if (card.days_left && *card.days_left < kFewDays)
        flags.add({"card", *card.days_left < kVeryFewDays ? Severity::kAlarm : Severity::kWarning,
                   health_text("The card lasts %.1f more days.", *card.days_left), kRoom});
    else if (card.in_quarantine && *card.in_quarantine > 0)
        flags.add({"card", Severity::kWarning,
                   health_text("%lld snapshots were damaged on the card, and are in quarantine.",
                               static_cast<long long>(*card.in_quarantine)),
                   "Run dicot verify; if the number grows, the card is dying: copy it and replace it."});
}

void judge_clock(const HealthFigures& now, HealthFlags& flags)
{
    if (now.clock_trust == ShortText<31>{"not set"})
        flags.add({"clock", Severity::kWarning, "The clock is not set: the times of the snapshots are wrong.",
                   "Give the board a network with NTP, or a clock with a battery; snapshots keep their order by "
                   "number."});
    else if (now.clock_error_s && *now.clock_error_s > kMostClockErrorS)
        flags.add({"clock", Severity::kNotice, health_text("The clock may be wrong by %.1f s.", *now.clock_error_s),
                   "See that its time server can be reached."});
}

void judge_temperature(const HealthHistory& history, const HealthFigures& now, HealthFlags& flags)
{
    if (!now.hottest_c)
        return;
    constexpr char kAction[] = "Shade the board, give its case air, and see that no other program keeps it busy.";
    const std::optional<double> before = usual(history, [](const HealthFigures& then) { return then.hottest_c; });
    if (*now.hottest_c >= kHot)
        flags.add({"hot", *now.hottest_c >= kVeryHot ? Severity::kAlarm : Severity::kWarning,
                   health_text("The board is hot: %.0f degrees Celsius.", *now.hottest_c), kAction});
    else if (before && *now.hottest_c >= kWarm && *now.hottest_c > *before + kWarmer)
        flags.add({"hot", Severity::kNotice,
                   health_text("The board is warmer than usual: %.0f degrees Celsius, and %.0f is usual.",
                               *now.hottest_c, *before),
                   kAction});
}

/// A process tells in each of its records what it found as it started: only the first of them is looked at.
void judge_start(const HealthHistory& history, const HealthFigures& now, HealthFlags& flags)
{
    const HealthRepairs& found = now.repairs;
    if (!history.empty() && history.back(0).repairs == found)
        return;
    if (found.interrupted + found.left_over + found.finished > 0)
        flags.add({"start", Severity::kNotice,
                   health_text("The start before this snapshot found %d that were interrupted: the power went, or the "
                               "program was stopped.",
                               found.interrupted + found.left_over + found.finished),
                   "See to the supply: a battery that sags, a plug, a switch; dicot list tells which were missed."});
    else if (found.catalogue_new && now.sequence > 1) // the first slot of a store makes its catalogue
        flags.add({"start", Severity::kNotice,
                   "The catalogue was damaged or missing, and was made again of the folders.",
                   "Run dicot verify: if more is damaged, the card is dying."});
}

} // namespace

void judge_board(const HealthHistory& history, const HealthFigures& figures, HealthFlags& flags) noexcept
{
    judge_card(figures.card, flags);
    judge_clock(figures, flags);
    judge_temperature(history, figures, flags);
    judge_start(history, figures, flags);
}

} // namespace dicot::app
