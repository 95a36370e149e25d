// What of a canopy is no leaf: stems, petioles, pots.
#pragma once

#include "basins.h"
#include "dicot/base/arena.h"
#include "dicot/plant/plant_view.h"
#include "surface.h"

namespace dicot {

/// Pieces that are no leaves become 0: narrow, paler than their plant, and facing the camera across their length.
void drop_stems(const PlantView& view, const Surface& surface, Pieces& pieces, Arena& arena);

} // namespace dicot
