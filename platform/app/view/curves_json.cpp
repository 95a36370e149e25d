#include "curves_json.h"

#include <nlohmann/json.hpp>

#include <string>

namespace dicot::app {
namespace {

using nlohmann::json;

constexpr double kSecond = 1e6; // us

json series_json(const BoardTraits& board, const PlantLife& life, const TraitSeries& series, const DayCount& days)
{
    json sequence = json::array(), time = json::array(), value = json::array(), sd = json::array();
    std::string outlier;
    for (std::size_t i = 0; i < series.samples.size(); ++i) {
        const SlotRow& row = board.slots[life.seen[i].slot].row;
        sequence.push_back(row.sequence);
        time.push_back(is_dated(row) ? json(static_cast<double>(row.began_us) / kSecond) : json{});
        value.push_back(series.samples[i].measured.value); // what is not a number becomes null
        sd.push_back(series.samples[i].measured.sd);
        outlier += series.fit.samples[i].use == SampleFit::Use::kOutlier ? '1' : '0';
    }
    json curve_time = json::array(), curve_value = json::array(), curve_sd = json::array();
    for (const GrowthPoint& point : series.fit.curve) {
        curve_time.push_back(static_cast<double>(days.utc_us(point.day)) / kSecond);
        curve_value.push_back(point.value.value);
        curve_sd.push_back(point.value.sd);
    }
    return {{"sequence", sequence}, {"time_s", time},
            {"value", value},       {"sd", sd},
            {"outlier", outlier},   {"curve", {{"time_s", curve_time}, {"value", curve_value}, {"sd", curve_sd}}}};
}

} // namespace

json no_curves()
{
    json traits = json::array();
    for (const PlantColumn& column : plant_columns())
        traits.push_back(
            {{"key", column.name}, {"name", column.words}, {"unit", column.drawn_unit}, {"scale", column.drawn_units}});
    return {{"complete", false}, {"slots", 0}, {"traits", traits}, {"plants", json::array()}, {"gaps", json::array()}};
}

json curves_json(const BoardTraits& board, const BoardGrowth& growth)
{
    json told = no_curves();
    told["slots"] = board.slots.size();
    for (const PlantGrowth& plant : growth.plants) {
        json series = json::object();
        for (const TraitSeries& one : plant.series)
            series[one.column->name] = series_json(board, plant.life, one, growth.days);
        told["plants"].push_back({{"name", plant.life.name}, {"series", series}});
    }
    for (const SeriesGap& gap : growth.gaps)
        if (gap.dated)
            told["gaps"].push_back({{"from_s", static_cast<double>(gap.from_us) / kSecond},
                                    {"to_s", static_cast<double>(gap.to_us) / kSecond},
                                    {"slots", gap.slots},
                                    {"reason", gap.reason}});
    return told;
}

} // namespace dicot::app
