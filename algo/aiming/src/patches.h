// Patches that stand out, and where the other picture shows them.
#pragma once

#include "levels.h"

#include <cstdint>
#include <span>

namespace dicot::aiming {

/// A patch of the left picture and its place in the right one, in pixels of one level.
struct Pair
{
    int level;
    int left_x, left_y;
    int right_x, right_y;
};

/// Working memory of find_pairs() for pictures of one size.
struct PatchTable
{
    std::span<std::uint64_t> left_bits,
        right_bits;                   ///< one word a pixel: which of the 8 x 8 around it are above their mean
    std::span<std::uint8_t> distance; ///< of one patch to all places of its search window
    std::span<Pair> pairs;
    int patches = 0; ///< looked for in the last search

    static std::size_t most_pairs(const Levels& levels);
    static PatchTable lay_out(Arena& arena, const Levels& levels);
};

/// Looks for places that are each other's best match, clearly better than the second best, in the two smallest levels:
/// small patches for what is small, large ones for what repeats itself. The span lies in `table`.
std::span<Pair> find_pairs(const Levels& left, const Levels& right, PatchTable& table);

} // namespace dicot::aiming
