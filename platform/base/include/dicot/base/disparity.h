// Disparity maps: what the matcher makes and the cloud is built from.
#pragma once

#include "dicot/base/image.h"

#include <cstdint>

namespace dicot {

/// Disparity above the search range's minimum, in 1/256 px. Left (x, y) matches right (x - d, y).
using DispQ8 = std::uint16_t;

inline constexpr int kDispFractionBits = 8;
inline constexpr DispQ8 kDispMissing = 0xFFFF;
/// The widest search range whose every sub-pixel disparity is below kDispMissing.
inline constexpr int kMaxDisparities = 255;
static_assert((kMaxDisparities << kDispFractionBits) < kDispMissing);

/// The disparity of the left picture: d = min_disparity + value / 256 px, or kDispMissing where a check failed.
struct DisparityMap
{
    ImageView<const DispQ8> relative;
    ImageView<const std::uint8_t> confidence; ///< 0 (a guess) .. 255 (certain); 0 where the disparity is missing
    int min_disparity = 0;                    ///< px
    int disparities = 0;                      ///< width of the search range, px
};

} // namespace dicot
