// What a pixel's neighbours of its colour say about its disparity.
#pragma once

#include "refine.h"

namespace dicot::matching {

/// Pixels that are not matched take the disparity, to a whole pixel, that most of the matched neighbours have, each
/// with the weight of its colour; they become kVoted. Where too few are of their colour, or do not agree, they stay as
/// they were, and so do those that have no matched pixel on one side of their row: what lies beyond the border is
/// nobody's to know. A later round counts those that were voted for before. (Region voting of Mei et al. 2011,
/// section 3.4, with support weights in place of crosses.)
void take_majorities(const Maps& maps, int disparities, const Planes& left, const ColourWeights& weights, Crew& crew);

} // namespace dicot::matching
