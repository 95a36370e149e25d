// How much leaf the left camera sees.
#pragma once

#include "leaf_surface.h"

#include "dicot/plant/traits.h"

namespace dicot {

/// The leaves of one plant: the surface of their blades, and what points do not tell of it.
///
/// - Near its border a leaf is steeper than what is measured: it curls there, it is smoothed from one side alone, and
///   the matcher makes it flatter. Not by the border cell's own slope, but by the leaf's.
/// - Cells without a point see as much as those with one, and more, as it is steep surfaces that have none.
///
/// Both by how much was found on rendered plants, and alike for each of six species when left out; neither adds
/// anything to a leaf that faces the camera with nothing in front of it. One standard deviation: of each leaf all of
/// the first, a third of the second, of the noise of z, and of what is taken for a leaf and is none.
Measured visible_area(const PlantView& view, const Leaves& leaves, const LeafSurfaces& surfaces, int plant);

} // namespace dicot
