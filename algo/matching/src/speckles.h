// Small islands of a disparity that their surroundings do not share.
#pragma once

#include "refine.h"

#include <span>

namespace dicot::matching {

/// Matched pixels become kMismatched where fewer than kLeastIsland of them hang together: side by side, within
/// kSameSurface of each other. `large` is scratch, one entry a column.
inline constexpr int kLeastIsland = 20;  ///< px
inline constexpr int kSameSurface = 256; ///< 1/256 px
void drop_speckles(const Maps& maps, std::span<std::uint8_t> large);

} // namespace dicot::matching
