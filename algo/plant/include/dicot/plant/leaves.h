// The cloud of a view cut into plants and leaves.
#pragma once

#include "dicot/plant/ground.h"
#include "dicot/plant/plant_view.h"

#include <cstdint>
#include <span>

namespace dicot {

/// One number a point, in the cloud's order.
struct Leaves
{
    static constexpr std::uint16_t kNone = 0;

    std::span<std::uint16_t> leaf; ///< 1 .. leaf_count, or kNone: no leaf, or too small a piece of one
    std::span<std::uint8_t> plant; ///< 1 .. plant_count: the canopy's points, leaves and stems; kNone: not green
    std::span<std::uint8_t> plant_of_leaf; ///< [leaf_count], the plant of leaf i + 1
    int leaf_count = 0;
    int plant_count = 0;
    GroundFrame ground;
};

} // namespace dicot
