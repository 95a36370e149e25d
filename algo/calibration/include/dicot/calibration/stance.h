// How a board stands before a camera whose lens nobody knows yet: enough to tell a person where to hold it next.
#pragma once

#include "dicot/calibration/board.h"

#include <span>
#include <vector>

namespace dicot::calibration {

struct Stance
{
    Point2 place;           ///< mean of the corners, as a share of the picture's width and height (0 .. 1)
    double distance_mm = 0; ///< of the board's middle along the camera's axis; as good as the focal length
    Point2 slope; ///< depth gained a step in the picture: x > 0 where the right edge is the farther one, y the
                  ///< lower edge; the tangent of the board's tilt
};

/// Whether the numbers of a camera can be guessed from so few boards: before that a common webcam's are taken.
constexpr std::size_t kFewestForFocal = 4;

/// The focal length that the boards suggest (Zhang's closed form), px, within half and twice the picture's width; a
/// common webcam's where there are fewer than kFewestForFocal. Each of `sights` holds the corners of one whole board.
double guess_focal_px(const Board& board, std::span<const std::vector<Point2>> sights, int width, int height);

/// `corners` are those of a found board. The lens is taken as straight, its centre as the picture's middle.
Stance stance_of(const Board& board, std::span<const Point2> corners, int width, int height, double focal_px);

/// Looks for the board as find_board() does, and sooner in a large picture: first at half the size, where the corners
/// come out to about 0.1 px, and at full size only where that shows none. For pictures that follow each other quickly.
BoardSight glance(ImageView<const std::uint8_t> grey, const Board& board);

} // namespace dicot::calibration
