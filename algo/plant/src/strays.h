// Patches that belong to a plant from above alone.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/plant/canopy.h"
#include "dicot/plant/plant_view.h"

namespace dicot {

/// Takes from each plant what stands apart from the rest of it by more than 100 mm in space and is less than a
/// twentieth of it: background that was taken for something near hangs in the air above a plant.
void drop_strays(const PlantView& view, Canopy& canopy, Arena& arena);

} // namespace dicot
