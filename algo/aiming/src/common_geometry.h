// What most of the sights agree on.
#pragma once

#include "follow.h"

#include <span>

namespace dicot::aiming {

/// How the right picture lies beside the left one: rise = rise_px + slope x + stretch y.
struct Geometry
{
    double rise_px = 0;
    double slope = 0;
    double stretch = 0;

    double rise_at(const Sight& sight) const { return rise_px + slope * sight.x + stretch * sight.y; }
};

/// Fits the geometry and brings the sights that agree with it to the front. Returns how many they are; fewer than
/// `fewest` are no agreement, and the geometry is then that of nothing.
std::size_t agree(std::span<Sight> sights, double width_px, std::size_t fewest, Geometry& geometry);

/// The shift that `rank` sights shift less than, once the roll between the pictures is taken out. Reorders the sights.
double ranked_shift(std::span<Sight> sights, const Geometry& geometry, std::size_t rank);

} // namespace dicot::aiming
