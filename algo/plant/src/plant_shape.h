// A plant as a whole: how high, how wide, how much room.
#pragma once

#include "leaf_surface.h"

#include "dicot/plant/traits.h"

namespace dicot {

/// Points of a plant, mm above and along the ground. Scratch from `arena`, in passing.
///
/// Projected area: on a raster of 4 mm each cell holds as much as the surfaces above it cover, and where that is
/// clearly more than itself, itself: neither a border nor leaves above each other count twice. Hull: of the highest and
/// lowest point of each cell, to the grid's step; exact for them.
void measure_plant(const PlantView& view, const Leaves& leaves, const LeafSurfaces& surfaces, Arena& arena,
                   PlantTraits& plant);

std::size_t plant_shape_bytes(std::size_t points);

} // namespace dicot
