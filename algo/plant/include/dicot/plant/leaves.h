// The cloud of a view cut into plants and leaves.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/status.h"
#include "dicot/plant/ground.h"
#include "dicot/plant/plant_box.h"
#include "dicot/plant/plant_view.h"

#include <cstddef>
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

/// What segment_leaves() takes from an arena at most.
std::size_t segment_leaves_bytes(const PlantView& view);

/// Finds ground, canopy, plants and leaves: algo/plant/README.md. With `boxes` plant i + 1 is what stands in boxes[i];
/// without, plants are told apart by the gaps between them. A cloud without anything green has no plants and no leaves.
/// Leaves are numbered from left to right by plant. Fault::kConfig: `arena` is too small.
Result<Leaves> segment_leaves(const PlantView& view, std::span<const PlantBox> boxes, Arena& arena);

} // namespace dicot
