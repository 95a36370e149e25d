// Matches that a second look takes back.
#pragma once

#include "refine.h"

#include <span>

namespace dicot::matching {

/// Matched pixels of which the disparity is one of the first `farther` become kMismatched and lose it: what they show
/// lies beyond the range. The others are counted from the end of these.
void drop_farther(const Maps& maps, int farther);

/// Matched pixels become kMismatched where their partner is one of the first columns of the right picture: the best one
/// may lie beyond. `min_disparity` is that of the search range.
void drop_clipped(const Maps& maps, int min_disparity);

/// Matched pixels become kMismatched where fewer than kLeastIsland of them hang together: side by side, within
/// kSameSurface of each other. `large` is scratch, one entry a column.
void drop_speckles(const Maps& maps, std::span<std::uint8_t> large);

} // namespace dicot::matching
