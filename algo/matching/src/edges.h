// Where colours change in the right picture.
#pragma once

#include "dicot/base/arena.h"
#include "planes.h"

#include <span>

namespace dicot::matching {

/// Colour edges between each pixel of the right picture and those beside it, for paths that move in both pictures at
/// once: a surface that ends there ends for the pixel's partner too.
class RightEdges
{
public:
    enum Side : std::uint8_t
    {
        kBefore = 1, ///< towards column - 1
        kAfter = 2,  ///< towards column + 1
        kAbove = 4,
        kBelow = 8
    };

    /// Columns of the search frame from -margin to width - 1.
    void lay_out(Arena& arena, int width, int height, int margin);
    /// Rows [from, to); the planes are full.
    void fill_rows(const Planes& right, int from, int to);

    /// Sides of row y at which colours change; [0] is column -margin.
    const std::uint8_t* row(int y) const { return sides_.data() + static_cast<std::size_t>(y) * stride(); }

private:
    std::size_t stride() const { return static_cast<std::size_t>(margin_ + width_); }

    int width_ = 0, height_ = 0, margin_ = 0;
    std::span<std::uint8_t> sides_;
};

} // namespace dicot::matching
