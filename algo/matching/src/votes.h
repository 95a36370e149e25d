// What a pixel's neighbours of its colour say about its disparity.
#pragma once

#include "refine.h"

namespace dicot::matching {

/// Pixels that are not matched take the disparity, to a whole pixel, that most of the matched neighbours have, each
/// with the weight of its colour; they become kVoted. Where too few are of their colour, or do not agree, they stay as
/// they were. Later rounds count those that were voted for before. (Region voting of Mei et al. 2011, with the support
/// weights in place of crosses.)
void take_majorities(const Maps& maps, int disparities, const Planes& left, const ColourWeights& weights, Crew& crew);

/// Medians after filling: 3 x 3 for what was matched; for everything else the colour-weighted median of its neighbours.
void smooth_by_votes(const Maps& maps, int disparities, const Planes& left, const ColourWeights& weights, Crew& crew);

} // namespace dicot::matching
