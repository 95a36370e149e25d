// Petioles cut off their blades.
#pragma once

#include "basins.h"
#include "dicot/base/arena.h"
#include "surface.h"

namespace dicot {

/// Where a piece goes on, thin, far from its wide part, that tail becomes a piece of its own, or none if it is small.
void cut_tails(const Surface& surface, Pieces& pieces, Arena& arena);

} // namespace dicot
