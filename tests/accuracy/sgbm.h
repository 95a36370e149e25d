// OpenCV's semi-global matcher: the peer that a board could run instead of ours.
#pragma once

#include "rectified_view.h"

namespace dicot::test {

/// StereoSGBM in its full mode (HH): block 5, penalties 8 and 32 x 3 x 25, left-right check 1 px, uniqueness 10 %,
/// speckles to 100 px within 2. `range` widens to a multiple of 16 disparities, as it demands.
Disparities sgbm_hh(const scenes::Picture& left, const scenes::Picture& right, const DisparityRange& range);

} // namespace dicot::test
