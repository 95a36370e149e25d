// What of a cloud is green, above the ground, and was seen rather than guessed.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/plant/ground.h"
#include "dicot/plant/plant_view.h"

#include <cstdint>
#include <span>

namespace dicot {

/// 1 for such a point, else 0. Patches that hang together are taken or left as a whole. Background that is taken for
/// something near has a mean confidence of 30 to 120 of 255, a leaf one of 160, a leaf in poor light one of 65 to 100:
/// a patch below 60 is left, and so is a small one below 125 with nothing of the plants beside it. Without any
/// confidence in the cloud every patch counts as seen.
void find_green(const PlantView& view, const GroundFrame& ground, std::span<std::uint8_t> green, Arena& arena);

} // namespace dicot
