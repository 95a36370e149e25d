// A second, narrow window over the costs that the wide one reads.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/kernels/kernels.h"

#include <span>

namespace dicot::matching {

class RawCosts;
struct Scene;

/// Eq. 13 over a window of 7 x 7 px. On a surface that slants the wide window mixes disparities and prefers
/// whole ones; a narrow one does less of it, and sees leaves that are thinner than the wide one.
class NearWindow
{
public:
    static constexpr int kRadius = 3; ///< px
    /// Pixels whose support weights are held at a time: long enough to spread the cost of moving the right table on,
    /// short enough for a group's tables and costs to stay in a 48 KiB first-level cache.
    static constexpr int kStrip = 32;

    void lay_out(Arena& arena, const Scene& scene);
    /// Fills its spatial weights, where it has any: to be done before the first strip.
    void clear();

    /// Adds the sums of pixels x0 .. x0 + count - 1 of row y, count at most kStrip, to [count][axis]. Strips of a row
    /// are asked for from left to right, each but the last as long as the strip.
    void aggregate(const Scene& scene, int y, int x0, int count, const RawCosts& raw, std::uint32_t* numerator,
                   std::uint32_t* denominator);

private:
    int right_stride_ = 0;
    std::span<std::uint16_t> left_spatial_, right_spatial_; ///< [window][window]
    std::span<PairU16> left_;                               ///< [window][strip]
    std::span<PairU16> right_;                              ///< [groups][window][right_stride]
};

} // namespace dicot::matching
