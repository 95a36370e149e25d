// Finding the inner corners of a plain chessboard in a picture, without a human.
#pragma once

#include "dicot/base/image.h"
#include "dicot/base/status.h"
#include "dicot/base/stereo_rig.h"

#include <cstdint>
#include <string>
#include <vector>

namespace dicot::calibration {

/// A plain chessboard, counted in inner corners (a board of 10 x 7 squares has 9 x 6).
struct Board
{
    int cols = 0;
    int rows = 0;
    double square_mm = 0;

    int corner_count() const { return cols * rows; }
    friend bool operator==(const Board&, const Board&) = default;
};

/// The smallest board that is looked for, and the largest.
constexpr int kMinBoardSide = 3;
constexpr int kMaxBoardSide = 60;

/// What one picture shows of a board.
struct BoardSight
{
    bool found = false;
    /// cols x rows corners, row after row, the first at the upper left of the picture; empty when not found.
    std::vector<Point2> corners;
    /// Whether the square between the first corners of the first two rows is the bright one.
    bool first_square_bright = false;
    /// Mean side of a square in the picture, in pixels.
    double square_px = 0;
    /// Why not, for a person ("7 of 9 rows found; board cut off at the top"); empty when found.
    std::string reason;
};

/// Refuses boards that cannot be looked for: sides outside kMinBoardSide..kMaxBoardSide, squares without a size.
Status check_board(const Board& board);

/// Looks for all inner corners of `board` in a grey picture; a board is found whole or not at all.
///
/// Corners are where the two edges of a square cross (to about 0.03 px in a clean picture). The order starts at the
/// corner nearest to the upper left of the picture and keeps the board's handedness: columns x rows turn as x and y do.
BoardSight find_board(ImageView<const std::uint8_t> grey, const Board& board);

/// Makes the right corner order name the same corners as the left one.
///
/// Boards that look the same after a turn leave the order open. The colour of the first square rules out turns;
/// of those that it allows, the one that leaves the board's axes most alike in both pictures is taken. kBadData when
/// no order, or more than one, is plausible.
Status agree_on_order(const Board& board, const BoardSight& left, BoardSight& right);

} // namespace dicot::calibration
