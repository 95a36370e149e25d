#include "dicot/plant/leaves.h"

#include "basins.h"
#include "dicot/plant/canopy.h"
#include "merge.h"
#include "surface.h"

#include <algorithm>

namespace dicot {

std::size_t segment_leaves_bytes(const PlantView& view)
{
    const std::size_t cells =
        (static_cast<std::size_t>(view.point.width) + 4) * (static_cast<std::size_t>(view.point.height) + 4);
    return 32 * cells + 32 * view.cloud.points.size() + (std::size_t{8} << 20);
}

Result<Leaves> segment_leaves(const PlantView& view, std::span<const PlantBox> boxes, Arena& arena)
{
    Leaves leaves;
    leaves.leaf = arena.take<std::uint16_t>(view.cloud.points.size());
    leaves.plant_of_leaf = arena.take<std::uint8_t>(UINT16_MAX);
    leaves.ground = find_ground(view, arena);
    Canopy canopy = find_canopy(view, leaves.ground, arena);
    stand_on_soil(view, canopy, leaves.ground, arena);
    if (!boxes.empty())
        put_in_boxes(view, leaves.ground, boxes, canopy);
    leaves.plant = canopy.plant;
    leaves.plant_count = canopy.plant_count;
    if (arena.overrun())
        return failure(Fault::kConfig, "too little memory to look for leaves");
    std::ranges::fill(leaves.leaf, Leaves::kNone);

    const std::size_t mark = arena.used();
    const Surface surface = surface_of(view, canopy, arena);
    Pieces pieces = cut_at_necks(surface, arena);
    merge_pieces(surface, pieces, arena);
    const std::span<std::int32_t> size = arena.take<std::int32_t>(static_cast<std::size_t>(pieces.count) + 1);
    if (arena.overrun())
        return failure(Fault::kConfig, "too little memory to look for leaves");
    std::ranges::fill(size, 0);
    for (std::size_t i = 0; i < surface.cells(); ++i)
        if (surface.cell[i] == Surface::kPoint)
            ++size[static_cast<std::size_t>(pieces.piece[i])];
    size[0] = 0;
    for (std::int32_t& s : size)
        s = s >= 120 ? ++leaves.leaf_count : 0;
    for (std::size_t i = 0; i < surface.cells(); ++i)
        if (surface.cell[i] == Surface::kPoint) {
            const auto p = static_cast<std::size_t>(surface.point(view, i));
            leaves.leaf[p] = static_cast<std::uint16_t>(size[static_cast<std::size_t>(pieces.piece[i])]);
            if (leaves.leaf[p])
                leaves.plant_of_leaf[leaves.leaf[p] - 1u] = leaves.plant[p];
        }
    leaves.plant_of_leaf = leaves.plant_of_leaf.first(static_cast<std::size_t>(leaves.leaf_count));
    arena.rewind(mark);
    return leaves;
}

} // namespace dicot
