#include "traits_csv.h"

#include "csv_cells.h"

#include "dicot/base/utc_time.h"

namespace dicot::app {
namespace {

std::string local_text(const DayCount& days, std::int64_t utc_us)
{
    const std::int64_t local_us = days.local_us(utc_us);
    std::string text = utc_text(local_us).c_str();
    text.pop_back(); // the Z
    return text + offset_text(static_cast<int>((local_us - utc_us) / 1'000'000)).c_str();
}

/// What every line begins with.
std::string slot_cells(const BoardTraits& board, const BoardGrowth& growth, const SlotTraits& slot)
{
    const std::int64_t at_us = slot.traits ? slot.row.began_us : slot.row.due_us.value_or(slot.row.began_us);
    return csv_cell(board.device) + "," + std::to_string(slot.row.sequence) + "," + utc_text(at_us).c_str() + "," +
           local_text(growth.days, at_us) + "," + csv_cell(std::string{slot.row.clock_trust.view()});
}

/// The traits of which this sighting is no part of the curve.
std::string outliers_at(const PlantGrowth& plant, std::size_t sighting)
{
    std::string names;
    for (const TraitSeries& series : plant.series)
        if (series.fit.samples[sighting].use == SampleFit::Use::kOutlier)
            names += (names.empty() ? "" : " ") + std::string{series.column->name};
    return names;
}

constexpr const char* kSlotNames = "device,sequence,time,local_time,clock_trust";

} // namespace

std::string plant_csv_names()
{
    return std::string{kSlotNames} + ",outcome,reason,plant,plant_name" + measured_names(plant_columns()) +
           ",greenness,points,cut,outlier_traits\n";
}

std::string plant_csv(const BoardTraits& board, const BoardGrowth& growth)
{
    std::vector<std::string> lines(board.slots.size());
    for (const PlantGrowth& plant : growth.plants)
        for (std::size_t k = 0; k < plant.life.seen.size(); ++k) {
            const Sighting& at = plant.life.seen[k];
            const SlotTraits& slot = board.slots[at.slot];
            const PlantTraits& traits = slot.traits->plants[at.index].traits;
            lines[at.slot] += slot_cells(board, growth, slot) + ",done,," + std::to_string(plant.life.id) + "," +
                              csv_cell(plant.life.name) + measured_cells(plant_columns(), traits) + "," +
                              csv_cell(traits.greenness) + "," + std::to_string(traits.points) + "," +
                              (traits.cut ? "1," : "0,") + outliers_at(plant, k) + "\n";
        }
    std::string csv;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const SlotTraits& slot = board.slots[i];
        if (!lines[i].empty()) {
            csv += lines[i];
            continue;
        }
        const std::string reason = slot.traits ? "no plant was found" : slot.gap;
        csv += slot_cells(board, growth, slot) +
               (slot.read       ? ",done,"
                : slot.row.done ? ",unread,"
                                : ",missed,") +
               csv_cell(reason) + "," + std::string(1 + 2 * plant_columns().size() + 4, ',') + "\n";
    }
    return csv;
}

std::string leaf_csv_names()
{
    return std::string{kSlotNames} + ",plant,plant_name,leaf,leaf_in_cloud" + measured_names(leaf_columns()) +
           ",greenness,points,hidden,cut,centre_x_mm,centre_y_mm,centre_z_mm\n";
}

std::string leaf_csv(const BoardTraits& board, const BoardGrowth& growth)
{
    std::vector<std::string> lines(board.slots.size());
    for (const PlantGrowth& plant : growth.plants)
        for (const LeafLife& leaf : plant.life.leaves)
            for (const Sighting& at : leaf.seen) {
                const SlotTraits& slot = board.slots[at.slot];
                const LeafTraits& traits = slot.traits->leaves[at.index];
                std::string& line = lines[at.slot];
                line += slot_cells(board, growth, slot) + "," + std::to_string(plant.life.id) + "," +
                        csv_cell(plant.life.name) + "," + std::to_string(leaf.id) + "," + std::to_string(traits.leaf) +
                        measured_cells(leaf_columns(), traits) + "," + csv_cell(traits.greenness) + "," +
                        std::to_string(traits.points) + (traits.hidden ? ",1" : ",0") + (traits.cut ? ",1" : ",0");
                for (const double axis : traits.centre_mm)
                    line += "," + csv_cell(axis);
                line += "\n";
            }
    std::string csv;
    for (const std::string& line : lines)
        csv += line;
    return csv;
}

} // namespace dicot::app
