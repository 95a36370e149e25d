// A plane through residuals of which up to a quarter may be anything.
#pragma once

#include "grey.h"

#include <cstddef>
#include <span>

namespace dicot::drift {

struct Plane
{
    double median = 0;  ///< of the residuals
    double spread = 0;  ///< median of the absolute deviations from it
    double slope_x = 0; ///< residual px a px
    double slope_y = 0;
    double at_origin = 0; ///< of the plane, at (0, 0)

    double at(double x, double y) const { return at_origin + slope_x * x + slope_y * y; }
};

/// Tukey's resistant line (Exploratory Data Analysis, 1977) along both axes in turn: through the medians of the outer
/// thirds. Sorts the sights; `values` has room for as many. At least three sights.
Plane resistant_plane(std::span<Sight> sights, std::span<double> values) noexcept;

} // namespace dicot::drift
