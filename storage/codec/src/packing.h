// How the attributes of a cloud lie in a file: whole numbers, and what turns them into lengths again.
#pragma once

#include "dicot/base/cloud.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// In the order of the file.
enum class Part
{
    kPosition,
    kColour,
    kConfidence,
    kLeaf
};
inline constexpr Part kParts[] = {Part::kPosition, Part::kColour, Part::kConfidence, Part::kLeaf};

constexpr std::span<const Part> parts_of(bool leaves)
{
    return std::span(kParts).first(leaves ? 4 : 3);
}

inline constexpr std::size_t kMostComponents = 3;

constexpr std::size_t components_of(Part part)
{
    return part == Part::kPosition || part == Part::kColour ? 3 : 1;
}

/// value = least + index * range / (2^bits - 1)
struct Quantisation
{
    float least[kMostComponents] = {};
    float range = 1;
    std::uint8_t bits = 0;

    friend bool operator==(const Quantisation&, const Quantisation&) = default;
};

inline float metres_of(std::int64_t steps, const CloudGrid& grid)
{
    return static_cast<float>(static_cast<double>(steps) * (grid.step_um * 1e-6));
}

/// Its steps are those of the grid.
inline Quantisation position_quantisation(const CloudGrid& grid)
{
    return {{metres_of(grid.origin[0], grid), metres_of(grid.origin[1], grid), metres_of(grid.origin[2], grid)},
            metres_of((std::int64_t{1} << grid.bits) - 1, grid),
            static_cast<std::uint8_t>(grid.bits)};
}

} // namespace dicot
