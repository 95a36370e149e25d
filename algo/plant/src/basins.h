// A surface cut at its necks.
#pragma once

#include "dicot/base/arena.h"
#include "surface.h"

#include <cstdint>
#include <span>

namespace dicot {

/// Pieces of the surface: [cell] 1 .. count, 0 where the surface is not.
struct Pieces
{
    std::span<std::int32_t> piece;
    int count = 0;
};

/// Floods the distance to the next tear from its peaks downwards; two basins become one where they meet at more than
/// 0.6 of the lower peak, and stay apart where the surface between them is a neck, as a petiole is, or a contact of
/// two blades.
Pieces cut_at_necks(const Surface& surface, Arena& arena);

} // namespace dicot
