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
    /// The last level is narrower and lower than this, px: it bounds the work, whatever the picture's shape.
    static constexpr int kNarrowerThan = 100, kLowerThan = 200;

    std::array<Grey, kMost> level; ///< [0] is the picture itself, borrowed
    int count = 0;

    const Grey& smallest() const { return level[static_cast<std::size_t>(count - 1)]; }
};

/// With a measuring arena, or one that is too small, the levels have no pixels.
Levels make_levels(Grey picture, Arena& arena);

} // namespace dicot::aiming
