// Figures out of records that anybody may have written.
#include "health_record.h"

#include "dicot/base/printable.h"
#include "dicot/base/utc_time.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <initializer_list>
#include <limits>

namespace dicot::app {
namespace {

using nlohmann::json;
using Keys = std::initializer_list<const char*>;

/// What stands behind these keys; null: nothing does.
const json* at(const json& record, Keys keys)
{
    const json* value = &record;
    for (const char* key : keys) {
        if (!value->is_object())
            return nullptr;
        const auto found = value->find(key);
        if (found == value->end())
            return nullptr;
        value = &*found;
    }
    return value;
}

std::optional<double> number(const json& record, Keys keys, double least, double most)
{
    const json* const value = at(record, keys);
    if (value == nullptr || !value->is_number())
        return std::nullopt;
    const double figure = value->get<double>();
    return std::isfinite(figure) && figure >= least && figure <= most ? std::optional{figure} : std::nullopt;
}

std::optional<std::int64_t> whole(const json& record, Keys keys, std::int64_t most)
{
    const std::optional<double> figure = number(record, keys, 0, static_cast<double>(most));
    return figure ? std::optional{static_cast<std::int64_t>(*figure)} : std::nullopt;
}

int count(const json& record, Keys keys)
{
    constexpr std::int64_t kMost = 1'000'000;
    return static_cast<int>(whole(record, keys, kMost).value_or(0));
}

bool yes(const json& record, Keys keys)
{
    const json* const value = at(record, keys);
    return value != nullptr && value->is_boolean() && value->get<bool>();
}

std::string_view text(const json& record, Keys keys)
{
    const json* const value = at(record, keys);
    return value != nullptr && value->is_string() ? std::string_view{value->get_ref<const std::string&>()}
                                                  : std::string_view{};
}

HealthSide side(const json& record, const char* name)
{
    return {number(record, {"shot", "mean_luma", name}, 0, 255),
            number(record, {"shot", "saturated_share", name}, 0, 1), number(record, {"health", "focus", name}, 0, 100)};
}

std::optional<HealthEpipolar> epipolar(const json& record)
{
    constexpr double kMost = 1e6;
    const auto figure = [&](const char* name) { return number(record, {"health", "epipolar", name}, -kMost, kMost); };
    const std::optional<double> median_px = figure("median_px");
    if (!median_px)
        return std::nullopt;
    HealthEpipolar rows;
    rows.median_px = *median_px;
    rows.spread_px = figure("spread_px").value_or(0);
    rows.roll_deg = figure("roll_deg").value_or(0);
    rows.height_ppm = figure("height_ppm").value_or(0);
    rows.corner_px = figure("corner_px").value_or(0);
    rows.points = count(record, {"health", "epipolar", "points"});
    return rows;
}

std::optional<double> fill(const json& record)
{
    constexpr double kMostSide = 1e5, kMostPoints = 1e10;
    const std::optional<double> points = number(record, {"cloud", "points"}, 0, kMostPoints);
    const std::optional<double> width = number(record, {"cloud", "width"}, 1, kMostSide);
    const std::optional<double> height = number(record, {"cloud", "height"}, 1, kMostSide);
    if (!points || !width || !height || *points > *width * *height)
        return std::nullopt;
    return *points / (*width * *height);
}

std::optional<double> hottest(const json& record)
{
    std::optional<double> most;
    const json* const sensors = at(record, {"temperatures_c"});
    if (sensors != nullptr && sensors->is_object())
        for (const json& sensor : *sensors) {
            const double celsius = sensor.is_number() ? sensor.get<double>() : -1e9;
            if (celsius >= -100 && celsius <= 300 && (!most || celsius > *most))
                most = celsius;
        }
    return most;
}

std::optional<double> scaled(std::optional<double> value, double by)
{
    return value ? std::optional{*value * by} : std::nullopt;
}

HealthRepairs repairs(const json& record)
{
    return {count(record, {"store", "finished"}), count(record, {"store", "interrupted"}),
            count(record, {"store", "left_over"}), count(record, {"store", "rows_added"}),
            yes(record, {"store", "catalogue_new"})};
}

} // namespace

HealthFigures figures_from_record(const json& record)
{
    constexpr std::int64_t kMostSequence = 999'999'999;
    constexpr double kMostMs = 1e9;
    HealthFigures figures;
    figures.sequence = whole(record, {"sequence"}, kMostSequence).value_or(0);
    figures.began_us = parse_utc_text(text(record, {"time"})).value_or(0);
    figures.done = text(record, {"outcome"}) == "done";
    figures.calibration_id = printable<63>(text(record, {"calibration_id"}));
    figures.left = side(record, "left");
    figures.right = side(record, "right");
    figures.epipolar = epipolar(record);
    figures.skew_ms = scaled(number(record, {"shot", "skew_us"}, -1000 * kMostMs, 1000 * kMostMs), 1e-3);
    figures.most_skew_ms = number(record, {"parameters", "burst", "most_skew_ms"}, 0, kMostMs);
    figures.fill = fill(record);
    figures.hottest_c = hottest(record);
    figures.clock_trust = printable<31>(text(record, {"clock", "trust"}));
    figures.clock_error_s = scaled(number(record, {"clock", "max_error_ms"}, 0, kMostMs), 1e-3);
    figures.card.days_left = number(record, {"health", "card", "days_left"}, 0, 1e9);
    figures.card.room_mib = number(record, {"health", "card", "room_mib"}, 0, 1e12);
    figures.card.in_quarantine = whole(record, {"health", "card", "in_quarantine"}, kMostSequence);
    figures.repairs = repairs(record);
    for (const char* name : {"left", "right"}) {
        for (const char* step : {"restarts", "reopens", "port_resets"})
            figures.shakes += count(record, {"cameras", name, "ladder", step});
        figures.gave_up = figures.gave_up || yes(record, {"cameras", name, "ladder", "gave_up"});
    }
    return figures;
}

std::size_t reference_from_record(const json& record, std::span<double> medians_px)
{
    const json* const all = at(record, {"health", "epipolar_reference"});
    std::size_t known = 0;
    if (all != nullptr && all->is_array())
        for (const json& one : *all)
            if (known < medians_px.size() && one.is_number() && std::fabs(one.get<double>()) < 100)
                medians_px[known++] = one.get<double>();
    return known;
}

} // namespace dicot::app
