#include "visible_area.h"

#include "root_of_squares.h"

#include <algorithm>

namespace dicot {

Measured visible_area(const PlantView& view, const Leaves& leaves, const LeafSurfaces& surfaces, int plant)
{
    // Cosines 1/3 and 2/3: the band between them is as wide as what lies below.
    constexpr double kSteep = 3, kSlanted = 1.5;
    double seen_mm2 = 0, slanted_mm2 = 0, missing = 0, noise = 0, cells = 0;
    for (int leaf = 1; leaf <= leaves.leaf_count; ++leaf) {
        if (leaves.plant_of_leaf[static_cast<std::size_t>(leaf - 1)] != plant)
            continue;
        const LeafGaps& gaps = surfaces.gaps[static_cast<std::size_t>(leaf - 1)];
        missing += gaps.inside_cells + gaps.beside_cells;
        for (const SurfaceCell& cell : surfaces.blade_of(leaf)) {
            const double side_mm = cell.z / view.focal_px;
            const double steepness = cell.area_mm2 / (side_mm * side_mm);
            if (steepness < kSteep)
                seen_mm2 += cell.area_mm2;
            if (steepness >= kSlanted && steepness < kSteep)
                slanted_mm2 += cell.area_mm2;
            noise += gaps.noise_mm / cell.z;
            cells += 1;
        }
    }
    if (cells == 0)
        return {};
    const double whole = 1 + missing / cells;
    const double area = (seen_mm2 + slanted_mm2) * whole;
    return {area, root_of_squares(slanted_mm2 * whole / 4, (seen_mm2 + slanted_mm2) * (whole - 1) / 3,
                                  2 * noise / cells * area)};
}

} // namespace dicot
