// Where the residual can be measured: corners and spots of the left picture, on surfaces that were matched.
#pragma once

#include "grey.h"

#include "dicot/base/disparity.h"

#include <optional>

namespace dicot::drift {

/// Cells that a picture is divided into, about square, at most EpipolarDrift::kMostPoints.
struct Cells
{
    int columns = 0, rows = 0;
};
Cells cells_of(int width, int height) noexcept;

/// The place in this cell with most texture along both axes; none: nothing there is textured and safely matched.
std::optional<Place> textured_place(Grey left, const DisparityMap& map, const Cells& cells, int column,
                                    int row) noexcept;

} // namespace dicot::drift
