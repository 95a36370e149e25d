#include "health_record.h"

#include "dicot/store/look.h"
#include "dicot/store/store.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>
#include <vector>

namespace dicot::app {
namespace {

using nlohmann::json;

template <typename Figure>
json known(const std::optional<Figure>& figure)
{
    return figure ? json(*figure) : json();
}

/// What is measured to a thousandth need not be told to the sixteenth digit.
json rounded(double value, double per_unit = 1000)
{
    return std::round(value * per_unit) / per_unit;
}

json epipolar_json(const std::optional<HealthEpipolar>& rows)
{
    if (!rows)
        return {};
    return {{"points", rows->points},
            {"median_px", rounded(rows->median_px)},
            {"spread_px", rounded(rows->spread_px)},
            {"roll_deg", rounded(rows->roll_deg, 10'000)},
            {"height_ppm", rounded(rows->height_ppm, 1)},
            {"corner_px", rounded(rows->corner_px)}};
}

json card_json(const HealthCard& card)
{
    return {{"days_left", card.days_left ? rounded(*card.days_left, 10) : json()},
            {"room_mib", card.room_mib ? rounded(*card.room_mib, 1) : json()},
            {"in_quarantine", known(card.in_quarantine)}};
}

json focus_json(const HealthFigures& figures)
{
    return {{"left", known(figures.left.focus)}, {"right", known(figures.right.focus)}};
}

} // namespace

void add_focus(HealthFigures& figures, const aiming::Focus& left, const aiming::Focus& right) noexcept
{
    const auto put = [](HealthSide& side, const aiming::Focus& focus) {
        if (focus.known())
            side.focus = focus.whole;
    };
    put(figures.left, left);
    put(figures.right, right);
}

void add_drift(HealthFigures& figures, const EpipolarDrift& drift) noexcept
{
    if (!drift.known())
        return;
    constexpr double kDegrees = 180 / std::numbers::pi; // a slope of a thousandth is its own tangent
    figures.epipolar = HealthEpipolar{drift.median_px,     drift.spread_px, -drift.slope_x * kDegrees,
                                      drift.slope_y * 1e6, drift.corner_px, drift.points};
}

HealthCard card_health(Medium& medium, Catalogue& catalogue, std::uint64_t reserve_bytes)
{
    HealthCard card;
    MediumSpace space;
    if (medium.space(space).ok()) {
        const double room =
            space.free_bytes > reserve_bytes ? static_cast<double>(space.free_bytes - reserve_bytes) : 0;
        card.room_mib = room / (1 << 20);
        if (const Result<SlotPace> pace = catalogue.pace(); pace.ok() && pace.value().bytes_per_day > 0)
            card.days_left = room / pace.value().bytes_per_day;
    }
    if (const Result<SlotTotals> totals = catalogue.totals(); totals.ok())
        card.in_quarantine = totals.value().quarantined;
    return card;
}

json health_record(const HealthFigures& figures, const HealthHistory& history, const HealthFlags& flags)
{
    json record = {{"focus", focus_json(figures)},
                   {"epipolar", epipolar_json(figures.epipolar)},
                   {"card", card_json(figures.card)},
                   {"flags", flags_json(flags)}};
    json reference = json::array();
    if (history.reference_id() == figures.calibration_id)
        for (const double median_px : history.reference_px())
            reference.push_back(rounded(median_px));
    record["epipolar_reference"] = reference;
    return record;
}

HealthFlags judge_and_record(json& record, const HealthFigures& figures, HealthHistory& history)
{
    const HealthFlags flags = judge_health(history, figures);
    history.add(figures);
    record["health"] = health_record(figures, history, flags);
    return flags;
}

json figures_json(const HealthFigures& figures)
{
    return {{"luma", {{"left", known(figures.left.luma)}, {"right", known(figures.right.luma)}}},
            {"saturated_share", {{"left", known(figures.left.saturated)}, {"right", known(figures.right.saturated)}}},
            {"focus", focus_json(figures)},
            {"epipolar", epipolar_json(figures.epipolar)},
            {"calibration_id", figures.calibration_id.view()},
            {"skew_ms", known(figures.skew_ms)},
            {"most_skew_ms", known(figures.most_skew_ms)},
            {"fill", known(figures.fill)},
            {"hottest_c", known(figures.hottest_c)},
            {"clock_trust", figures.clock_trust.view()},
            {"clock_error_s", known(figures.clock_error_s)},
            {"card", card_json(figures.card)},
            {"start",
             {{"finished", figures.repairs.finished},
              {"interrupted", figures.repairs.interrupted},
              {"left_over", figures.repairs.left_over},
              {"rows_added", figures.repairs.rows_added},
              {"catalogue_new", figures.repairs.catalogue_new}}},
            {"camera_shakes", figures.shakes},
            {"camera_gave_up", figures.gave_up}};
}

json flags_json(const HealthFlags& flags)
{
    json all = json::array();
    for (const HealthFlag& flag : flags)
        all.push_back({{"id", flag.id},
                       {"severity", name_of(flag.severity)},
                       {"cause", flag.cause.view()},
                       {"action", flag.action.view()}});
    return all;
}

std::optional<HealthFigures> read_figures(Medium& medium, const SlotRow& row, HealthHistory& history)
{
    if (row.kept != Kept::kHere)
        return std::nullopt;
    const Result<std::string> text = read_record_text(medium, row);
    const json record = text.ok() ? json::parse(text.value(), nullptr, false) : json();
    if (!record.is_object())
        return std::nullopt;
    const HealthFigures figures = figures_from_record(record);
    std::array<double, HealthHistory::kReference> medians_px{};
    const std::size_t known = reference_from_record(record, medians_px);
    if (figures.epipolar && known > 0 && !(history.reference_id() == figures.calibration_id))
        // The last one is its own, which the history hears of in a moment.
        history.set_reference(figures.calibration_id,
                              std::span{medians_px}.first(known < medians_px.size() ? known - 1 : known));
    return figures;
}

HealthHistory read_history(Medium& medium, Catalogue& catalogue, std::int64_t slots)
{
    HealthHistory history;
    SlotQuery query;
    query.last = slots;
    std::vector<SlotRow> rows;
    if (!catalogue
             .for_each(query,
                       [&](const SlotRow& row) {
                           rows.push_back(row);
                           return true;
                       })
             .ok())
        return history;
    for (const SlotRow& row : rows)
        if (const auto figures = read_figures(medium, row, history))
            history.add(*figures);
    return history;
}

} // namespace dicot::app
