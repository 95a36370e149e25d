#include "edges.h"

#include "paths.h"

namespace dicot::matching {

void RightEdges::lay_out(Arena& arena, int width, int height, int margin)
{
    width_ = width;
    height_ = height;
    margin_ = margin;
    sides_ = arena.take<std::uint8_t>(stride() * static_cast<std::size_t>(height));
}

void RightEdges::fill_rows(const Planes& right, int from, int to)
{
    // Nothing is known of what lies outside the picture; there is no edge towards it.
    const auto edge = [](LabRow row, int i, LabRow other, int j) {
        return row.la[i].low != kLabOutside && other.la[j].low != kLabOutside &&
               colour_edge(row, i, other, j, kBestEdge);
    };
    for (int y = from; y < to; ++y) {
        const LabRow row = right.lab(y), above = right.lab(y - 1), below = right.lab(y + 1);
        std::uint8_t* const sides = sides_.data() + static_cast<std::size_t>(y) * stride();
        for (int column = -margin_; column < width_; ++column) {
            const bool before = column > -margin_ && edge(row, column, row, column - 1);
            const bool after = column + 1 < width_ && edge(row, column, row, column + 1);
            sides[column + margin_] = static_cast<std::uint8_t>((before ? kBefore : 0) | (after ? kAfter : 0) |
                                                                (edge(row, column, above, column) ? kAbove : 0) |
                                                                (edge(row, column, below, column) ? kBelow : 0));
        }
    }
}

} // namespace dicot::matching
