// What of a cloud is green, above the ground, and was seen rather than guessed.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/plant/ground.h"
#include "dicot/plant/plant_view.h"

#include <cstdint>
#include <span>

namespace dicot {

/// 1 for such a point, else 0. Patches that hang together are taken or left as a whole. Background beyond the working
/// range that is taken for something near has a mean confidence of 35 to 40 of 255, a leaf one of 150, a leaf in poor
/// light one of 50: a patch below 42 is left, and so is a small one with nothing of the plants beside it. Without any
/// confidence in the cloud every patch counts as seen.
void find_green(const PlantView& view, const GroundFrame& ground, std::span<std::uint8_t> green, Arena& arena);

} // namespace dicot
