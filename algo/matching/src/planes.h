// The two pictures as the kernels read them: colour and census planes with room for the window beyond the borders.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/image.h"
#include "dicot/kernels/kernels.h"
#include "lab.h"

#include <span>

namespace dicot::matching {

/// One picture. Column x of the *search frame* may lie outside the picture: from -margin_left to width + margin_right
/// - 1. For the left picture the search frame is the picture; for the right one it is shifted by the least disparity,
/// so that column x - d of the frame is the partner of left column x at relative disparity d.
class Planes
{
public:
    void lay_out(Arena& arena, int width, int height, int margin_left, int margin_right);

    /// Fills rows [from, to) from `picture`, whose column x - shift appears as column x of the frame.
    /// The census of a row reads its neighbours in the picture, so rows may be filled in any order.
    void fill_rows(ImageView<const Rgb8> picture, int shift, const LabTables& tables, int from, int to);

    /// Row y of the Lab planes, or a row of outside pixels when y is outside; [0] is column 0 of the frame.
    LabRow lab(int y) const;
    /// Row y (inside) of the channel and census planes; [0] is column 0 of the frame.
    CostRow cost(int y) const;

private:
    std::size_t offset(int y, int column) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_) +
               static_cast<std::size_t>(margin_left_ + column);
    }

    int height_ = 0, margin_left_ = 0, stride_ = 0;
    std::span<PairS16> la_, b_; // one more row than the picture: the outside
    std::span<std::uint8_t> red_, green_, blue_, census_;
};

} // namespace dicot::matching
