// Grey pictures of this room.
#pragma once

#include "dicot/base/image.h"

#include <cstdint>

namespace dicot::drift {

using Grey = ImageView<const std::uint8_t>;

/// Windows that are compared reach so far from their middle.
inline constexpr int kRadius = 6;
inline constexpr int kSide = 2 * kRadius + 1;
inline constexpr int kPixels = kSide * kSide;

/// A place of the left picture, and how far to the left the right picture shows it.
struct Place
{
    int x = 0, y = 0;
    double disparity_px = 0;
};

/// The same place in the right picture.
struct Sight
{
    double x = 0, y = 0;    ///< in the right picture
    double residual_px = 0; ///< y in the right picture minus y in the left one
};

} // namespace dicot::drift
