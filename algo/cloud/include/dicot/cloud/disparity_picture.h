// A disparity map that people can look at.
#pragma once

#include "dicot/base/disparity.h"
#include "dicot/base/image.h"

namespace dicot {

/// Paints `map` in the turbo colours: near is red, far is blue, missing is dark grey. The colours span the disparities
/// between the 1st and the 99th percentile. `into` has the size of the map.
void paint_disparities(const DisparityMap& map, ImageView<Rgb8> into);

} // namespace dicot
