// The rendered rig as `dicot calibrate` finds it from both of its boards.
#pragma once

#include "dicot/base/stereo_rig.h"

namespace dicot::test {

/// Solved when it is asked for first. Stops the program with the reason where that fails.
const StereoRig& own_rig();

} // namespace dicot::test
