// The surface of each leaf, freed from the noise of its points.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/plant/leaves.h"
#include "dicot/plant/plant_view.h"

#include <cstdint>
#include <span>

namespace dicot {

/// What one cell of the picture sees of a leaf. mm of the camera's frame.
struct SurfaceCell
{
    float x, y, z;
    float area_mm2;       ///< of the surface within the cell
    float from_above_mm2; ///< the same, projected along the ground's `up`
    std::int32_t point;   ///< in the cloud
};

/// What is no point and yet may be leaf, and what is not certain.
struct LeafGaps
{
    float inside_cells = 0; ///< without a point, both neighbours in the row of this leaf
    float beside_cells = 0; ///< without a point, between this leaf and something nearer
    float noise_mm = 0;     ///< of z, about the local planes: one standard deviation
};

/// Cells leaf by leaf: those of leaf i + 1 are cells[first[i]] .. cells[first[i + 1] - 1].
struct LeafSurfaces
{
    std::span<SurfaceCell> cells;
    std::span<std::int32_t> first; ///< [leaf_count + 1]
    std::span<LeafGaps> gaps;      ///< [leaf_count]
    std::span<std::int32_t> blade; ///< [leaf_count]: so many of its cells, the first, are blade; the others petiole

    std::span<SurfaceCell> of(int leaf) const
    {
        const auto at = static_cast<std::size_t>(leaf);
        const auto from = static_cast<std::size_t>(first[at - 1]), to = static_cast<std::size_t>(first[at]);
        return cells.subspan(from, to - from);
    }
    std::span<SurfaceCell> blade_of(int leaf) const
    {
        return of(leaf).first(static_cast<std::size_t>(blade[static_cast<std::size_t>(leaf - 1)]));
    }
};

/// Inverse depth is affine in the picture for a plane (1/z = a + b u + c v): fitted to the leaf's points within
/// kSmoothing_mm of each, by least squares, it gives the cell's place and, by its gradient, its area.
/// All cells are blade until somebody tells them apart. Empty spans where `arena` is too small.
LeafSurfaces leaf_surfaces(const PlantView& view, const Leaves& leaves, Arena& arena);

} // namespace dicot
