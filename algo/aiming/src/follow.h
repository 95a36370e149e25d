// Pairs found in small pictures, made exact in the full ones.
#pragma once

#include "patches.h"

#include <optional>
#include <span>

namespace dicot::aiming {

/// A pair in the full pictures. Positions from the middle of the pictures; to about a tenth of a pixel.
struct Sight
{
    double x, y;     ///< in the left picture, px
    double shift_px; ///< x_left - x_right
    double rise_px;  ///< y_right - y_left
};

/// Follows a pair from its level down to the full pictures; nothing if it looks like chance on the way.
std::optional<Sight> follow(const Levels& left, const Levels& right, Pair pair);

} // namespace dicot::aiming
