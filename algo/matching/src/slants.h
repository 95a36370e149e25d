// Surfaces carried on into what only one camera sees.
#pragma once

#include "refine.h"

namespace dicot::matching {

/// Gives a value to every pixel that is neither matched nor voted for: the planes through the two nearest ones of the
/// row that are, fitted to their surroundings, are carried on, and the farther one counts, which is the one that can be
/// hidden. Beside the picture's borders there is one plane. A row without any match copies its neighbour. What is
/// filled has confidence 0.
void fill_along_planes(const Maps& maps, int disparities, const Planes& left, const ColourWeights& weights, Crew& crew);

} // namespace dicot::matching
