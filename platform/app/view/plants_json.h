// Plants, leaves and their traits as the page reads them.
#pragma once

#include "../plant/plant_work.h"
#include "seen_pictures.h"

#include <string>

namespace dicot::app {

/// grid, ground, plants, leaves: README.md, "What the page reads".
std::string plants_json(const PlantWork& work, const GridPlace& place);
/// The leaf of each point, 16 bits, little-endian; behind them the plant of each, 8 bits.
std::string leaf_bytes(const Leaves& leaves);

} // namespace dicot::app
