// The volume that a rubber skin around points would hold.
#pragma once

#include "dicot/base/arena.h"

#include <cstdint>
#include <span>

namespace dicot {

struct GridPoint
{
    std::int32_t x, y, z; ///< |each| <= kHullReach
};

/// Differences then stay below 2^19 and six times a tetrahedron's volume below 2^60.
inline constexpr std::int32_t kHullReach = 1 << 18;

/// Six times the volume of the convex hull of `points`, exact; 0 when they lie in a plane. Incremental, in integers: a
/// point is beyond a face or not, nothing is nearly so. n points and f faces take n f steps. Memory from `arena`, in
/// passing: hull_bytes(n). Negative where that is too small.
std::int64_t hull_volume_x6(std::span<const GridPoint> points, Arena& arena);

std::size_t hull_bytes(std::size_t points);

} // namespace dicot
