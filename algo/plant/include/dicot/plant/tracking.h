// The same plant, and the same leaf, in the next snapshot.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/plant/ground.h"
#include "dicot/plant/leaves.h"
#include "dicot/plant/plant_view.h"
#include "dicot/plant/traits.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// Where a plant stands, in a frame that stays: the camera's.
struct PlantStand
{
    double centre_mm[3] = {}; ///< mean of its points
    double up[3] = {0, -1, 0};
    double spread_mm = 0; ///< root mean square distance of its points from the upright line through the centre
};

/// What a leaf is known again by.
struct LeafMark
{
    double centre_mm[3] = {}; ///< camera frame
    double along[3] = {};     ///< base to tip, mm
    double area_mm2 = 0;
};

inline constexpr std::int32_t kNobody = -1;

/// Of each plant of the view, 1 .. plant_count.
void plant_stands(const PlantView& view, const Leaves& leaves, std::span<PlantStand> stands);

LeafMark mark_of(const LeafTraits& leaf);

/// Pairs of both, each at most once, the nearest first: no farther apart than the larger one spreads, or than a hand is
/// wide (60 mm). Heights do not count, plants grow. known_of[i] is which of `known` stands[i] is, or kNobody.
/// Fault::kSoftware: the arena is too small.
Status match_plants(std::span<const PlantStand> known, std::span<const PlantStand> stands,
                    std::span<std::int32_t> known_of, Arena& scratch);

/// The same for the leaves of one plant: by where they are, how their midribs lie (either way round: which end is the
/// base may be mistaken) and how large they are. A leaf may move by its own size (the root of its area) and grow or
/// shrink fourfold. `known` are all that may come again.
Status match_leaves(std::span<const LeafMark> known, std::span<const LeafMark> leaves, std::span<std::int32_t> known_of,
                    Arena& scratch);

/// What either takes of the arena at most.
std::size_t match_bytes(std::size_t known, std::size_t seen);

} // namespace dicot
