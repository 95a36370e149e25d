// Which plant, and which leaf, is the same one from snapshot to snapshot.
#pragma once

#include "board_traits.h"

#include <cstddef>
#include <string>
#include <vector>

namespace dicot::app {

/// Where in BoardTraits something was seen.
struct Sighting
{
    std::size_t slot = 0;
    std::size_t index = 0; ///< in its plants or in its leaves
};

struct LeafLife
{
    int id = 0; ///< from 1, within its plant, never given twice
    std::vector<Sighting> seen;
};

struct PlantLife
{
    int id = 0;       ///< from 1, by when it was first seen
    std::string name; ///< of its place, or "plant 1"
    std::vector<Sighting> seen;
    std::vector<LeafLife> leaves;
};

/// A leaf that was not seen in so many snapshots of its plant is not looked for any more: another one may grow there.
inline constexpr int kLeafRemembered = 5;

/// With places a plant is its place; without, it is where it stands. Fault::kOsError without memory.
Result<std::vector<PlantLife>> follow_lives(const BoardTraits& board, std::span<const PlantPlace> places);

} // namespace dicot::app
