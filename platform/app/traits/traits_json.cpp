#include "traits_json.h"

#include "dicot/base/utc_time.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace dicot::app {

using nlohmann::json;

namespace {

/// NaN becomes null.
json json_of(const Measured& measured)
{
    return {measured.value, measured.sd};
}

const char* name_of(SampleFit::Use use)
{
    switch (use) {
    case SampleFit::Use::kUsed:
        return "used";
    case SampleFit::Use::kOutlier:
        return "outlier";
    case SampleFit::Use::kUnmeasured:
        break;
    }
    return "unmeasured";
}

json series_json(const BoardTraits& board, const PlantLife& life, const TraitSeries& series, const DayCount& days)
{
    json samples = json::array(), curve = json::array(), daily;
    for (std::size_t k = 0; k < series.samples.size(); ++k) {
        const SampleFit& fit = series.fit.samples[k];
        const SlotRow& row = board.slots[life.seen[k].slot].row;
        samples.push_back({{"sequence", row.sequence},
                           {"time", utc_text(row.began_us).view()},
                           {"value", json_of(series.samples[k].measured)},
                           {"use", name_of(fit.use)},
                           {"expected", json_of(fit.expected)},
                           {"miss", fit.miss}});
    }
    for (const GrowthPoint& point : series.fit.curve)
        curve.push_back({{"time", utc_text(days.utc_us(point.day)).view()},
                         {"value", json_of(point.value)},
                         {"rate_per_day", json_of(point.rate_per_day)},
                         {"relative_rate_per_day", json_of(point.relative_rate_per_day)}});
    if (series.fit.daily_known) {
        daily = json::array();
        for (const Measured& hour : series.fit.daily)
            daily.push_back(json_of(hour));
    }
    return {{"trait", series.column->name},
            {"unit", series.column->unit},
            {"used", series.fit.used},
            {"outliers", series.fit.outliers},
            {"sd_factor", series.fit.sd_factor},
            {"longest_bridge_days", series.fit.longest_bridge_days},
            {"samples", samples},
            {"curve", curve},
            {"daily", daily}};
}

json leaf_json(const BoardTraits& board, const LeafLife& leaf)
{
    json areas = json::array();
    for (const Sighting& at : leaf.seen) {
        const SlotTraits& slot = board.slots[at.slot];
        areas.push_back({slot.row.sequence, slot.traits->leaves[at.index].area_mm2.value});
    }
    return {{"leaf", leaf.id},
            {"first", utc_text(board.slots[leaf.seen.front().slot].row.began_us).view()},
            {"last", utc_text(board.slots[leaf.seen.back().slot].row.began_us).view()},
            {"snapshots", leaf.seen.size()},
            {"area_mm2", areas}};
}

} // namespace

json growth_json(const BoardTraits& board, const BoardGrowth& growth)
{
    json gaps = json::array(), plants = json::array();
    for (const SeriesGap& gap : growth.gaps)
        gaps.push_back({{"from", gap.dated ? json(utc_text(gap.from_us).view()) : json{}},
                        {"to", gap.dated ? json(utc_text(gap.to_us).view()) : json{}},
                        {"slots", gap.slots},
                        {"reason", gap.reason}});
    for (const PlantGrowth& plant : growth.plants) {
        json series = json::array(), leaves = json::array();
        for (const TraitSeries& one : plant.series)
            series.push_back(series_json(board, plant.life, one, growth.days));
        for (const LeafLife& leaf : plant.life.leaves)
            leaves.push_back(leaf_json(board, leaf));
        plants.push_back({{"plant", plant.life.id},
                          {"name", plant.life.name},
                          {"snapshots", plant.life.seen.size()},
                          {"series", series},
                          {"leaves", leaves}});
    }
    const auto measured =
        std::ranges::count_if(board.slots, [](const SlotTraits& slot) { return slot.traits.has_value(); });
    return {{"device", board.device}, {"timezone", board.zone.name()},  {"slots", board.slots.size()},
            {"measured", measured},   {"from_cache", board.from_cache}, {"gaps", gaps},
            {"plants", plants}};
}

} // namespace dicot::app
