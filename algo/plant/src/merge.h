// Pieces of one blade put together again.
#pragma once

#include "basins.h"
#include "dicot/base/arena.h"
#include "surface.h"

namespace dicot {

/// No more pieces than these are looked at, the largest.
inline constexpr int kMostPieces = 400;

/// Pieces become one where one smooth surface goes through both. Pieces too small to tell are dropped.
void merge_pieces(const Surface& surface, Pieces& pieces, Arena& arena);

} // namespace dicot
