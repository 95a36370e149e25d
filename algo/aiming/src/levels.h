// A picture at full, half, quarter ... size.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/image.h"

#include <array>
#include <cstdint>

namespace dicot::aiming {

using Grey = ImageView<const std::uint8_t>;

/// Pixel x of a level covers pixels 2 x and 2 x + 1 of the one below.
struct Levels
{
    static constexpr int kMost = 6;
    static constexpr int kSmallestBelow = 100; ///< px, the width of the last level

    std::array<Grey, kMost> level; ///< [0] is the picture itself, borrowed
    int count = 0;

    const Grey& smallest() const { return level[static_cast<std::size_t>(count - 1)]; }
};

/// With a measuring arena, or one that is too small, the levels have no pixels.
Levels make_levels(Grey picture, Arena& arena);

} // namespace dicot::aiming
