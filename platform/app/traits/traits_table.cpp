#include "traits_table.h"

#include "../store/shown.h"

#include "dicot/base/utc_time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <span>

namespace dicot::app {
namespace {

constexpr std::size_t kMostGaps = 6;

/// Filled up to so many characters; what begins with 10 in UTF-8 is none of its own.
std::string padded(std::string text, std::ptrdiff_t width)
{
    const auto characters =
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
    text.append(static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, width - characters)), ' ');
    return text;
}

std::string series_line(const TraitSeries& series)
{
    const auto newest = std::find_if(series.fit.curve.rbegin(), series.fit.curve.rend(),
                                     [](const GrowthPoint& point) { return std::isfinite(point.value.value); });
    if (newest == series.fit.curve.rend())
        return "";
    const double scale = series.column->drawn_units;
    char line[200];
    std::snprintf(line, sizeof line, "%9.1f", scale * newest->value.value);
    std::string text = "  " + padded(series.column->words, 34) + line;
    line[0] = '\0'; // two samples without sd leave none
    if (std::isfinite(newest->value.sd))
        std::snprintf(line, sizeof line, " +- %.1f", scale * newest->value.sd);
    text += padded(line, 11) + padded(series.column->drawn_unit, 4);
    if (is_rate_known(*newest)) {
        std::snprintf(line, sizeof line, "%+9.1f +- %-7.1f a day", scale * newest->rate_per_day.value,
                      scale * newest->rate_per_day.sd);
        text += line;
        if (std::isfinite(newest->relative_rate_per_day.value)) {
            std::snprintf(line, sizeof line, " (%+.1f %%)", 100 * newest->relative_rate_per_day.value);
            text += line;
        }
    }
    if (series.fit.outliers > 0)
        text += "; " + counted(series.fit.outliers, "outlier");
    if (series.fit.daily_known)
        text += "; time of day apart";
    return text + "\n";
}

std::string dates_of(const BoardTraits& board, std::span<const Sighting> seen)
{
    std::string first, last;
    for (const Sighting& at : seen)
        if (const SlotRow& row = board.slots[at.slot].row; is_dated(row)) {
            last = utc_text(row.began_us).c_str();
            if (first.empty())
                first = last;
        }
    return first.empty() ? "no date" : first + " to " + last;
}

std::string plant_words(const BoardTraits& board, const PlantGrowth& plant)
{
    std::string text = shown(plant.life.name) + ": " + counted(std::ssize(plant.life.seen), "snapshot") + ", " +
                       dates_of(board, plant.life.seen) + "\n";
    for (const TraitSeries& series : plant.series)
        text += series_line(series);
    const auto now = std::ranges::count_if(
        plant.life.leaves, [&](const LeafLife& leaf) { return leaf.seen.back().slot == plant.life.seen.back().slot; });
    return text + "  " + std::to_string(plant.life.leaves.size()) + " leaves were seen, " + std::to_string(now) +
           " of them in the last snapshot\n";
}

/// The longest ones, in the order of time.
std::string gap_words(std::vector<SeriesGap> gaps)
{
    const std::size_t all = gaps.size();
    std::ranges::stable_sort(gaps, std::ranges::greater{}, &SeriesGap::slots);
    gaps.resize(std::min(all, kMostGaps));
    std::ranges::sort(gaps, {}, &SeriesGap::from_us);
    std::string text;
    for (const SeriesGap& gap : gaps)
        text += (gap.dated ? std::string{"  gap between "} + utc_text(gap.from_us).c_str() + " and " +
                                 utc_text(gap.to_us).c_str()
                           : "  gap without a date") +
                ": " + counted(gap.slots, "slot") + ", " + shown(gap.reason) + "\n";
    if (all > gaps.size())
        text += "  and " + counted(static_cast<std::int64_t>(all - gaps.size()), "shorter gap") + ": --csv has all\n";
    return text;
}

} // namespace

std::string growth_words(const BoardTraits& board, const BoardGrowth& growth)
{
    const auto measured =
        std::ranges::count_if(board.slots, [](const SlotTraits& slot) { return slot.traits.has_value(); });
    std::string text = shown(board.device) + ": " + counted(std::ssize(board.slots), "slot") + ", " +
                       std::to_string(measured) + " measured (" + std::to_string(board.from_cache) +
                       " before), time of day in " + board.zone.name() + "\n";
    text += gap_words(growth.gaps);
    for (const PlantGrowth& plant : growth.plants)
        if (!plant.life.seen.empty())
            text += plant_words(board, plant);
    return text;
}

} // namespace dicot::app
