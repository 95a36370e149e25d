// How much leaf the left camera sees.
#pragma once

#include "leaf_surface.h"

#include "dicot/plant/traits.h"

namespace dicot {

/// The leaves of one plant, with what their points do not tell:
///
/// - A surface that is seen under more than 70 degrees has few cells, which the matcher makes flatter than they are: of
///   10 mm2 it leaves 4. Per cosine it is taken for as much as there is between 48 and 70 degrees, as on leaves that
///   are turned every way; that is a quarter to a half of the whole.
/// - Cells without a point see as much as those with one, within a leaf and behind what stands in front of it.
///
/// One standard deviation: a quarter of the first, a third of the second, and the noise of z.
Measured visible_area(const PlantView& view, const Leaves& leaves, const LeafSurfaces& surfaces, int plant);

} // namespace dicot
