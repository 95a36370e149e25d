#include "visible_area.h"

#include "root_of_squares.h"

namespace dicot {
namespace {

/// So many cells from where its leaf ends a cell is of the rim.
constexpr int kRim = 3;
/// So much of itself the rim adds to a leaf seen along its surface, and by the squared sine of the slant to others. 0.8
/// fits rendered leaves best, nothing flat ones.
constexpr double kRimAdds = 0.7;
/// A cell without a point sees so much of the leaf, taken by the mean of those with one.
constexpr double kGapSees = 1.8;
/// Fruit, stems and pots among the leaves: of what is found, one standard deviation.
constexpr double kNoLeafSd = 0.05;

bool at_rim(const PlantView& view, const Leaves& leaves, int leaf, const SurfaceCell& cell)
{
    const int column = static_cast<int>(view.focal_px * cell.x / cell.z + view.cx_px + 0.5);
    const int row = static_cast<int>(view.focal_px * cell.y / cell.z + view.cy_px + 0.5);
    const auto is_leaf = [&](int c, int r) {
        if (c < 0 || r < 0 || c >= view.point.width || r >= view.point.height)
            return false;
        const std::int32_t point = view.point.at(c, r);
        return point != PlantView::kNoPoint && leaves.leaf[static_cast<std::size_t>(point)] == leaf;
    };
    return !(is_leaf(column - kRim, row) && is_leaf(column + kRim, row) && is_leaf(column, row - kRim) &&
             is_leaf(column, row + kRim));
}

} // namespace

Measured visible_area(const PlantView& view, const Leaves& leaves, const LeafSurfaces& surfaces, int plant)
{
    double area = 0, rims_squared = 0, gaps_mm2 = 0, noise = 0;
    for (int leaf = 1; leaf <= leaves.leaf_count; ++leaf) {
        const std::span<const SurfaceCell> cells = surfaces.blade_of(leaf);
        if (leaves.plant_of_leaf[static_cast<std::size_t>(leaf - 1)] != plant || cells.empty())
            continue;
        double surface = 0, rim = 0, facing = 0;
        for (const SurfaceCell& cell : cells) {
            const double side_mm = cell.z / view.focal_px;
            facing += side_mm * side_mm;
            surface += cell.area_mm2;
            rim += at_rim(view, leaves, leaf, cell) ? cell.area_mm2 : 0;
        }
        const double cosine = facing / surface;
        const double rim_adds = kRimAdds * (1 - cosine * cosine) * rim;
        const LeafGaps& gaps = surfaces.gaps[static_cast<std::size_t>(leaf - 1)];
        const double share = kGapSees * (gaps.inside_cells + gaps.beside_cells) / double(cells.size());
        const double whole = surface + rim_adds;
        area += whole * (1 + share);
        gaps_mm2 += whole * share;
        rims_squared += rim_adds * rim_adds;
        noise += whole * gaps.noise_mm / cells[0].z;
    }
    if (area == 0)
        return {};
    return {area, root_of_squares(root_of_squares(std::sqrt(rims_squared), gaps_mm2 / 3), 2 * noise, kNoLeafSd * area)};
}

} // namespace dicot
