// A cloud on the grid of the picture that it was seen in.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/cloud.h"
#include "dicot/base/image.h"
#include "dicot/base/status.h"

#include <cstdint>

namespace dicot {

/// Neighbours in the picture are neighbours in memory. Column of a point = focal_px * x / z + cx_px, row = focal_px *
/// y / z + cy_px, rounded; of two points in one cell the nearer one stands there.
struct PlantView
{
    static constexpr std::int32_t kNoPoint = -1;
    static constexpr std::int32_t kMostCells = 1 << 22;
    /// An empty pot or a dark picture leaves as few, scattered: their steps do not tell how wide a pixel is.
    static constexpr std::size_t kFewPoints = 5000;

    PointCloud cloud;              ///< borrowed; points keep their order
    ImageView<std::int32_t> point; ///< index into cloud.points, or kNoPoint
    double focal_px = 0;
    double cx_px = 0;
    double cy_px = 0;
    bool too_few = false; ///< points, to show a grid: it is one empty cell, and nothing can be measured

    double mm_per_step() const { return cloud.grid.step_um / 1000.0; }
};

/// Finds the grid from the points alone (they stand row by row, left to right, one a pixel: triangulate()), so that a
/// cloud from a file needs no rig. Fault::kBadData: no points; more than kFewPoints and no such grid, or one of more
/// than kMostCells; Fault::kConfig: `arena` is too small (kMostCells * 4 bytes suffice, and 512 KiB in passing).
Result<PlantView> plant_view(const PointCloud& cloud, Arena& arena);

} // namespace dicot
