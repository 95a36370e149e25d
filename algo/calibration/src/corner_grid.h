// A whole board cut out of a lattice, and its turns.
#pragma once

#include "dicot/calibration/board.h"
#include "lattice.h"

#include <optional>
#include <vector>

namespace dicot::calibration {

/// cols x rows corners, row after row; x along the columns, y along the rows, x turned to y as in the picture.
struct CornerGrid
{
    int cols = 0;
    int rows = 0;
    std::vector<Point2> corners;
    bool first_square_bright = false;

    Point2 at(int col, int row) const { return corners[static_cast<std::size_t>(row * cols + col)]; }
    /// Unit vectors of the mean direction of the rows (x) and of the columns (y) in the picture.
    Point2 x_direction() const;
    Point2 y_direction() const;
    /// The mean step between neighbours at a corner, along a row and along a column.
    Point2 x_step(int col, int row) const;
    Point2 y_step(int col, int row) const;
};

/// The same corners, counted from the next corner of the board: x runs where y ran.
CornerGrid quarter_turned(const CornerGrid& grid);

struct CutOut
{
    std::optional<CornerGrid> grid;
    bool larger_board = false; ///< complete rows or columns go on beyond the board that was asked for
};

/// The cols x rows (or rows x cols) crossings of `lattice`, when it holds exactly one such rectangle.
CutOut cut_out(const Lattice& lattice, const Board& board);

/// The turn of `grid` with the size of `board` whose first corner is the upper left one in the picture.
CornerGrid upright(CornerGrid grid, const Board& board);

} // namespace dicot::calibration
