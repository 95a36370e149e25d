// The exact place where two edges cross.
#pragma once

#include "grey_level.h"
#include "saddle.h"

#include <optional>

namespace dicot::calibration {

/// Which edges of a window say where the crossing is.
enum class Edges
{
    kAll,     ///< those that pass it far off count less, once it is roughly known
    kCloseBy, ///< those that pass it far off never count: for a crossing that is known already, in odd light
};

/// Refines a crossing: every gradient in the window is perpendicular to the line that joins it with the crossing
/// (Foerstner and Guelch 1987, in the form of OpenCV's cornerSubPix). The pattern's own gradients cancel over a window
/// that is centred on the crossing; what is left is uneven light, and is taken away first. The window is the
/// parallelogram at +- half_u +- half_v, fading to its rim; it moves with the estimate. Nothing when the window shows
/// only one edge or the estimate runs further than `max_move_px`.
std::optional<Point2> refine_crossing(const GreyLevel& level, Point2 start, Point2 half_u, Point2 half_v,
                                      double max_move_px, Edges edges = Edges::kAll);

} // namespace dicot::calibration
