#include "snapshot_traits.h"

#include "../cloud_on_disk.h"
#include "trait_columns.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace dicot::app {

using nlohmann::json;

namespace {

double number(const json& value)
{
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN(); // null: NaN
}

template <typename Columns, typename Traits>
json measured_json(const Columns& columns, const Traits& traits)
{
    json all = json::array();
    for (const auto& column : columns) {
        all.push_back((traits.*column.measured).value);
        all.push_back((traits.*column.measured).sd);
    }
    return all;
}

template <typename Columns, typename Traits>
void measured_from(const json& all, const Columns& columns, Traits& traits)
{
    for (std::size_t k = 0; k < columns.size(); ++k)
        traits.*columns[k].measured = {number(all.at(2 * k)), number(all.at(2 * k + 1))};
}

template <std::size_t Count>
void numbers_from(const json& all, double (&into)[Count])
{
    for (std::size_t k = 0; k < Count; ++k)
        into[k] = number(all.at(k));
}

PlantSeen plant_from(const json& one)
{
    PlantSeen seen;
    seen.traits.plant = one.at("plant").get<int>();
    seen.traits.points = one.at("points").get<std::int64_t>();
    seen.traits.greenness = number(one.at("greenness"));
    seen.traits.cut = one.at("cut").get<bool>();
    measured_from(one.at("measured"), plant_columns(), seen.traits);
    numbers_from(one.at("centre"), seen.stand.centre_mm);
    numbers_from(one.at("up"), seen.stand.up);
    seen.stand.spread_mm = number(one.at("spread"));
    return seen;
}

LeafTraits leaf_from(const json& one)
{
    LeafTraits leaf;
    leaf.leaf = one.at("leaf").get<int>();
    leaf.plant = one.at("plant").get<int>();
    leaf.points = one.at("points").get<std::int64_t>();
    leaf.greenness = number(one.at("greenness"));
    leaf.hidden = one.at("hidden").get<bool>();
    leaf.cut = one.at("cut").get<bool>();
    measured_from(one.at("measured"), leaf_columns(), leaf);
    numbers_from(one.at("centre"), leaf.centre_mm);
    numbers_from(one.at("base"), leaf.base_mm);
    numbers_from(one.at("tip"), leaf.tip_mm);
    return leaf;
}

/// Without a ground nobody knows which way is up: such figures are not to stand in a curve beside true ones.
void forget_upright(SnapshotTraits& traits)
{
    constexpr Measured kUnknown{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    for (PlantSeen& seen : traits.plants)
        for (const auto figure :
             {&PlantTraits::height_max_mm, &PlantTraits::height_p99_mm, &PlantTraits::height_top10_mean_mm,
              &PlantTraits::projected_area_mm2, &PlantTraits::inclination_mean_deg})
            seen.traits.*figure = kUnknown;
    for (LeafTraits& leaf : traits.leaves)
        leaf.inclination_deg = leaf.azimuth_deg = kUnknown;
}

} // namespace

Result<SnapshotTraits> SnapshotTraits::read(const std::string& path, std::span<const PlantPlace> places)
{
    const CloudOnDisk cloud = TRY(CloudOnDisk::read(path.c_str()));
    const PlantWork work = TRY(PlantWork::make(cloud.cloud(), path.c_str(), places, cloud.meta().far_mm.value_or(0)));
    SnapshotTraits traits;
    traits.too_few_points = work.view().too_few;
    traits.ground_known = work.leaves().ground.kind != GroundFrame::Kind::kNone;
    std::vector<PlantStand> stands(work.traits().plants.size());
    plant_stands(work.view(), work.leaves(), stands);
    for (std::size_t i = 0; i < stands.size(); ++i)
        traits.plants.push_back({work.traits().plants[i], stands[i]});
    traits.leaves.assign(work.traits().leaves.begin(), work.traits().leaves.end());
    if (!traits.ground_known)
        forget_upright(traits);
    return traits;
}

json json_of(const SnapshotTraits& traits)
{
    json plants = json::array(), leaves = json::array();
    for (const PlantSeen& seen : traits.plants)
        plants.push_back({{"plant", seen.traits.plant},
                          {"points", seen.traits.points},
                          {"greenness", seen.traits.greenness},
                          {"cut", seen.traits.cut},
                          {"measured", measured_json(plant_columns(), seen.traits)},
                          {"centre", seen.stand.centre_mm},
                          {"up", seen.stand.up},
                          {"spread", seen.stand.spread_mm}});
    for (const LeafTraits& leaf : traits.leaves)
        leaves.push_back({{"leaf", leaf.leaf},
                          {"plant", leaf.plant},
                          {"points", leaf.points},
                          {"greenness", leaf.greenness},
                          {"hidden", leaf.hidden},
                          {"cut", leaf.cut},
                          {"measured", measured_json(leaf_columns(), leaf)},
                          {"centre", leaf.centre_mm},
                          {"base", leaf.base_mm},
                          {"tip", leaf.tip_mm}});
    return {{"too_few_points", traits.too_few_points},
            {"ground", traits.ground_known},
            {"plants", plants},
            {"leaves", leaves}};
}

std::optional<SnapshotTraits> traits_of(const json& from)
{
    try {
        SnapshotTraits traits;
        traits.too_few_points = from.at("too_few_points").get<bool>();
        traits.ground_known = from.at("ground").get<bool>();
        for (const json& one : from.at("plants"))
            traits.plants.push_back(plant_from(one));
        for (const json& one : from.at("leaves"))
            traits.leaves.push_back(leaf_from(one));
        return traits;
    } catch (const json::exception&) {
        return std::nullopt;
    }
}

} // namespace dicot::app
