#include "plants_json.h"

#include "../store/slot_words.h"

#include <nlohmann/json.hpp>

#include <cstdint>

namespace dicot::app {
namespace {

using nlohmann::json;

json json_of(const Measured& measured)
{
    // What is not a number becomes null.
    return {{"value", measured.value}, {"sd", measured.sd}};
}

json json_of(const PlantTraits& plant, const std::string& name)
{
    return {{"plant", plant.plant},
            {"name", name},
            {"points", plant.points},
            {"height_p99_mm", json_of(plant.height_p99_mm)},
            {"height_top10_mean_mm", json_of(plant.height_top10_mean_mm)},
            {"leaf_area_visible_mm2", json_of(plant.leaf_area_visible_mm2)},
            {"projected_area_mm2", json_of(plant.projected_area_mm2)},
            {"hull_volume_mm3", json_of(plant.hull_volume_mm3)},
            {"leaf_count", json_of(plant.leaf_count)},
            {"inclination_mean_deg", json_of(plant.inclination_mean_deg)},
            {"greenness", plant.greenness},
            {"cut", plant.cut}};
}

json json_of(const LeafTraits& leaf)
{
    return {{"leaf", leaf.leaf},
            {"plant", leaf.plant},
            {"points", leaf.points},
            {"length_mm", json_of(leaf.length_mm)},
            {"width_mm", json_of(leaf.width_mm)},
            {"area_mm2", json_of(leaf.area_mm2)},
            {"inclination_deg", json_of(leaf.inclination_deg)},
            {"azimuth_deg", json_of(leaf.azimuth_deg)},
            {"curvature_per_m", json_of(leaf.curvature_per_m)},
            {"greenness", leaf.greenness},
            {"hidden", leaf.hidden},
            {"cut", leaf.cut}};
}

} // namespace

std::string plants_json(const PlantWork& work, const GridPlace& place)
{
    const PlantView& view = work.view();
    const GroundFrame& ground = work.leaves().ground;
    json plants = json::array();
    for (const PlantTraits& plant : work.traits().plants)
        plants.push_back(json_of(plant, work.plant_name(plant.plant)));
    json leaves = json::array();
    for (const LeafTraits& leaf : work.traits().leaves)
        leaves.push_back(json_of(leaf));
    json grid; // null of too few points
    if (!view.too_few)
        grid = {{"width", place.width},
                {"height", place.height},
                {"focal_px", view.focal_px},
                {"cx_px", view.cx_px + place.column},
                {"cy_px", view.cy_px + place.row}};
    return json_text({{"grid", grid},
                      {"ground",
                       {{"kind", name_of(ground.kind)},
                        {"origin_mm", ground.origin_mm},
                        {"right", ground.right},
                        {"away", ground.away},
                        {"up", ground.up},
                        {"rms_mm", ground.rms_mm},
                        {"height_sd_mm", ground.height_sd_mm}}},
                      {"plants", plants},
                      {"leaves", leaves}},
                     -1);
}

std::string leaf_bytes(const Leaves& leaves)
{
    std::string bytes;
    bytes.reserve(leaves.leaf.size() * 3);
    for (const std::uint16_t leaf : leaves.leaf) {
        bytes += static_cast<char>(leaf & 0xFF);
        bytes += static_cast<char>(leaf >> 8);
    }
    for (const std::uint8_t plant : leaves.plant)
        bytes += static_cast<char>(plant);
    return bytes;
}

} // namespace dicot::app
