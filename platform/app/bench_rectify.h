// How fast a pair is rectified: a yardstick of dicot bench.
#pragma once

#include "dicot/base/status.h"
#include "dicot/kernels/kernels.h"

namespace dicot::app {

struct RectifySpeed
{
    static constexpr int kWidth = 1280;
    static constexpr int kHeight = 720;
    static constexpr int kRounds = 31;

    double pair_ms = 0; ///< processor time of both pictures: the median of kRounds, after one that does not count
    double pixels_per_s() const { return 2.0 * kWidth * kHeight / (pair_ms * 1e-3); }
};

/// Two colour pictures through the tables of two ordinary webcams, one thread, memory in use before. Errors: those of
/// the rectification, kOsError without memory.
Result<RectifySpeed> time_rectify(const Kernels& kernels);

} // namespace dicot::app
