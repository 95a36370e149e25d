#include "corner_grid.h"

#include <algorithm>

namespace dicot::calibration {

namespace {

constexpr double kLineGoesOn = 0.6; // of a line beyond the board, from which on the board is a larger one

struct Window
{
    int i0, j0, wide, high;
};

bool is_full(const Lattice& lattice, const Window& w)
{
    for (int j = 0; j < w.high; ++j)
        for (int i = 0; i < w.wide; ++i)
            if (!lattice.contains({w.i0 + i, w.j0 + j}))
                return false;
    return true;
}

bool line_goes_on(const Lattice& lattice, Cell from, Cell step, int count)
{
    int there = 0;
    for (int k = 0; k < count; ++k)
        there += lattice.contains({from.i + k * step.i, from.j + k * step.j}) ? 1 : 0;
    return there >= kLineGoesOn * count;
}

bool has_more_lines(const Lattice& lattice, const Window& w)
{
    return line_goes_on(lattice, {w.i0 - 1, w.j0}, {0, 1}, w.high) ||
           line_goes_on(lattice, {w.i0 + w.wide, w.j0}, {0, 1}, w.high) ||
           line_goes_on(lattice, {w.i0, w.j0 - 1}, {1, 0}, w.wide) ||
           line_goes_on(lattice, {w.i0, w.j0 + w.high}, {1, 0}, w.wide);
}

} // namespace

Point2 CornerGrid::x_direction() const
{
    Point2 sum{};
    for (int row = 0; row < rows; ++row)
        sum = sum + at(cols - 1, row) - at(0, row);
    return unit(sum);
}

Point2 CornerGrid::y_direction() const
{
    Point2 sum{};
    for (int col = 0; col < cols; ++col)
        sum = sum + at(col, rows - 1) - at(col, 0);
    return unit(sum);
}

Point2 CornerGrid::x_step(int col, int row) const
{
    const int before = std::max(col - 1, 0);
    const int after = std::min(col + 1, cols - 1);
    return (1.0 / (after - before)) * (at(after, row) - at(before, row));
}

Point2 CornerGrid::y_step(int col, int row) const
{
    const int before = std::max(row - 1, 0);
    const int after = std::min(row + 1, rows - 1);
    return (1.0 / (after - before)) * (at(col, after) - at(col, before));
}

CornerGrid quarter_turned(const CornerGrid& grid)
{
    CornerGrid turned{grid.rows, grid.cols, {}, grid.first_square_bright};
    turned.corners.reserve(grid.corners.size());
    for (int row = 0; row < turned.rows; ++row)
        for (int col = 0; col < turned.cols; ++col)
            turned.corners.push_back(grid.at(grid.cols - 1 - row, col));
    // The last square of the old first row becomes the first one; cols - 2 squares lie between.
    if ((grid.cols - 2) % 2 != 0)
        turned.first_square_bright = !grid.first_square_bright;
    return turned;
}

CutOut cut_out(const Lattice& lattice, const Board& board)
{
    const Extent e = extent_of(lattice);
    CutOut result;
    int fitting = 0;
    const auto try_size = [&](int wide, int high) {
        for (int j0 = e.j0; j0 + high - 1 <= e.j1; ++j0)
            for (int i0 = e.i0; i0 + wide - 1 <= e.i1; ++i0) {
                const Window w{i0, j0, wide, high};
                if (!is_full(lattice, w))
                    continue;
                ++fitting;
                result.larger_board = result.larger_board || has_more_lines(lattice, w);
                CornerGrid grid{wide, high, {}, lattice.at({i0, j0}).bright};
                for (int j = 0; j < high; ++j)
                    for (int i = 0; i < wide; ++i)
                        grid.corners.push_back(lattice.at({i0 + i, j0 + j}).at);
                result.grid = std::move(grid);
            }
    };
    try_size(board.cols, board.rows);
    if (board.cols != board.rows)
        try_size(board.rows, board.cols);
    if (fitting > 1)
        result.larger_board = true;
    if (result.larger_board)
        result.grid.reset();
    return result;
}

CornerGrid upright(CornerGrid grid, const Board& board)
{
    CornerGrid best;
    double best_score = -3;
    for (int turn = 0; turn < 4; ++turn, grid = quarter_turned(grid)) {
        if (grid.cols != board.cols || grid.rows != board.rows)
            continue;
        const double score = grid.x_direction().x + grid.y_direction().y;
        if (score > best_score) {
            best_score = score;
            best = grid;
        }
    }
    return best;
}

} // namespace dicot::calibration
