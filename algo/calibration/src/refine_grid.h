// All corners of a board to a few hundredths of a pixel.
#pragma once

#include "corner_grid.h"
#include "grey_level.h"

namespace dicot::calibration {

/// Moves every corner of `grid` to the exact crossing in `level`. Corners that cannot be measured at once, or lie out
/// of line with their neighbours (a shadow's edge, dirt), are measured again from where the neighbours put them,
/// counting only edges that pass close by. `scale` is the size of the level that the grid was found in, 1 for full
/// size. False when a corner cannot be measured or the rows are no rows.
bool refine_grid(const GreyLevel& level, double scale, CornerGrid& grid);

} // namespace dicot::calibration
