// What stands around a leaf.
#pragma once

#include "dicot/plant/leaves.h"
#include "dicot/plant/plant_view.h"

#include <cstdint>
#include <span>

namespace dicot {

/// Counts of a leaf's border: one for each cell and side where the leaf ends.
struct LeafBorder
{
    std::int32_t sides = 0;
    std::int32_t behind = 0; ///< what comes next there stands in front of the leaf
    std::int32_t cut = 0;    ///< nothing comes next: the picture or the working range ends
};

/// `borders`: one a leaf. `far_mm`: end of the working range, 0 where it is not known.
void find_borders(const PlantView& view, const Leaves& leaves, double far_mm, std::span<LeafBorder> borders);

} // namespace dicot
