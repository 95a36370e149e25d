// Equations 16 to 18 of the paper, in integers.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/cloud.h"
#include "dicot/base/disparity.h"
#include "dicot/base/image.h"
#include "dicot/base/status.h"
#include "dicot/cloud/working_range.h"

#include <cstdint>

namespace dicot {

/// The constants of triangulation: lengths in grid steps, times px, with 24 fraction bits.
///
/// With D = d + offset in 24 fraction bits and b the baseline in steps:
///   Z = f b / D,   X = (x - cx) b / D,   Y = (y - cy) b / D,
/// each one 64-bit division, rounded to the nearest step, half away from zero. |numerator| <= 2^58, so numerator + D /
/// 2 is below 2^63. For D >= 1 px and coordinates within 2^20 steps the constants' own rounding moves a result by less
/// than 1/16 step.
struct Triangulation
{
    static constexpr int kFractionBits = 24;

    std::int64_t depth_q24 = 0;       ///< f b
    std::int64_t pixel_q24 = 0;       ///< b
    std::int64_t column_zero_q24 = 0; ///< cx b
    std::int64_t row_zero_q24 = 0;    ///< cy b
    std::int64_t offset_q24 = 0;      ///< px
    std::int64_t near_steps = 0;
    std::int64_t far_steps = 0;
    CloudGrid grid;
};

/// Makes the constants. Refuses a rig outside the bounds of working_range.h.
Result<Triangulation> triangulation_for(const RigGeometry& rig, const WorkingRange& range, const CloudGrid& grid);

/// Where the pixels of a disparity map went. The six add up to width x height.
struct PixelCount
{
    std::int64_t points = 0;
    std::int64_t missing = 0; ///< no disparity
    std::int64_t beyond = 0;  ///< d + offset <= 0: at infinity or past it
    std::int64_t too_near = 0;
    std::int64_t too_far = 0;
    std::int64_t outside_grid = 0;
};

struct Triangulated
{
    PointCloud cloud; ///< row by row, left to right: the order of the picture
    PixelCount pixels;
};

/// One point for each pixel of `map` that has a disparity, lies within the working range and on the grid; colour from
/// the same pixel of `left` (same size as the map), confidence from the map. The points are carved from `arena`, room
/// for every pixel; with a measuring arena, or one that is too small, the cloud is empty (see Arena::overrun).
Triangulated triangulate(const DisparityMap& map, ImageView<const Rgb8> left, const Triangulation& how, Arena& arena);

} // namespace dicot
