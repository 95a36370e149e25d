#include "../store/shown.h"
#include "../traits/csv_cells.h"
#include "../traits/trait_columns.h"
#include "plant_report.h"

#include <cstdio>

namespace dicot::app {
namespace {

constexpr const char* kCloudNames = "cloud,device,sequence,captured_at,ground,plant,plant_name";

std::string cloud_cells(const PlantReport& report, int plant)
{
    const CloudMeta& meta = report.meta;
    return csv_cell(report.cloud) + "," + csv_cell(std::string{meta.device_id.view()}) + "," +
           (meta.sequence ? std::to_string(*meta.sequence) : "") + "," +
           csv_cell(std::string{meta.captured_at.view()}) + "," + name_of(report.work.leaves().ground.kind) + "," +
           std::to_string(plant) + "," + csv_cell(report.work.plant_name(plant));
}

std::string place_names(const char* of)
{
    std::string names;
    for (const char* axis : {"x", "y", "z"})
        names += std::string{","} + of + "_" + axis + "_mm";
    return names;
}

std::string place_cells(const double (&place_mm)[3])
{
    std::string cells;
    for (const double axis : place_mm)
        cells += "," + csv_cell(axis);
    return cells;
}

} // namespace

std::string plant_table(const PlantReport& report)
{
    std::string table = kCloudNames + measured_names(plant_columns()) + ",greenness,points,cut\n";
    for (const PlantTraits& plant : report.work.traits().plants)
        table += cloud_cells(report, plant.plant) + measured_cells(plant_columns(), plant) + "," +
                 csv_cell(plant.greenness) + "," + std::to_string(plant.points) + (plant.cut ? ",1\n" : ",0\n");
    return table;
}

std::string leaf_table(const PlantReport& report)
{
    std::string table = std::string{kCloudNames} + ",leaf" + measured_names(leaf_columns()) +
                        ",greenness,points,hidden,cut" + place_names("centre") + place_names("base") +
                        place_names("tip") + "\n";
    for (const LeafTraits& leaf : report.work.traits().leaves)
        table += cloud_cells(report, leaf.plant) + "," + std::to_string(leaf.leaf) +
                 measured_cells(leaf_columns(), leaf) + "," + csv_cell(leaf.greenness) + "," +
                 std::to_string(leaf.points) + (leaf.hidden ? ",1" : ",0") + (leaf.cut ? ",1" : ",0") +
                 place_cells(leaf.centre_mm) + place_cells(leaf.base_mm) + place_cells(leaf.tip_mm) + "\n";
    return table;
}

std::string plant_words(const PlantReport& report)
{
    const PlantWork& work = report.work;
    const GroundFrame& ground = work.leaves().ground;
    char line[200];
    std::string words;
    const auto say = [&](const char* format, auto... values) {
        std::snprintf(line, sizeof line, format, values...);
        words += line;
    };
    words += shown(report.cloud) + ": " + counted(static_cast<std::int64_t>(work.traits().plants.size()), "plant") +
             ", ground: " + name_of(ground.kind);
    words += ground.kind == GroundFrame::Kind::kNone ? "; heights are not to be believed" : "";
    words += work.view().too_few ? "; too few points to find plants in\n" : "\n";
    for (const PlantTraits& plant : work.traits().plants) {
        words += shown(work.plant_name(plant.plant)) + (plant.cut ? ", leaves the view\n" : "\n");
        for (const PlantColumn& column : plant_columns()) {
            const Measured& measured = plant.*column.measured;
            say("  %-36s %9.1f +- %.1f %s\n", column.words, measured.value * column.drawn_units,
                measured.sd * column.drawn_units, column.drawn_unit);
        }
        say("  %-36s %9.2f\n", "greenness", plant.greenness);
        words += "  leaf   length +-      width +-     area +-      inclination  points\n"
                 "             mm            mm          cm2              deg\n";
        for (const LeafTraits& leaf : work.traits().leaves)
            if (leaf.plant == plant.plant)
                say("  %4d  %7.1f %-5.1f %7.1f %-5.1f %7.1f %-5.1f %7.0f      %7lld%s%s\n", leaf.leaf,
                    leaf.length_mm.value, leaf.length_mm.sd, leaf.width_mm.value, leaf.width_mm.sd,
                    leaf.area_mm2.value / 100, leaf.area_mm2.sd / 100, leaf.inclination_deg.value,
                    static_cast<long long>(leaf.points), leaf.hidden ? "  partly hidden" : "", leaf.cut ? "  cut" : "");
    }
    return words;
}

} // namespace dicot::app
