#include "paths.h"

namespace dicot::matching {

std::uint16_t TwoSidedStep::operator()(std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                                       std::uint16_t least, bool left_edge, const std::uint8_t* sides,
                                       unsigned side) const
{
    const int first = scene.axis - scene.disparities;
    const auto step = [&](std::uint16_t* to, PathPenalty penalty) {
        return scene.kernels->path_step(to, costs, behind, least, penalty, first, scene.axis);
    };
    if (left_edge)
        return step(ahead, steps.across);
    unsigned any = 0;
    for (int r = 0; r < scene.axis; ++r)
        any |= sides[r];
    const std::uint16_t least_within = step(ahead, steps.within);
    if ((any & side) == 0)
        return least_within;
    step(scratch, steps.across);
    std::uint16_t least_ahead = kNoCandidate;
    for (int r = 0; r < scene.axis; ++r) {
        const auto edge = static_cast<std::uint16_t>((sides[r] & side) != 0 ? 0xFFFF : 0);
        const auto value = static_cast<std::uint16_t>((scratch[r] & edge) | (ahead[r] & ~edge));
        ahead[r] = value;
        least_ahead = std::min(least_ahead, value);
    }
    return least_ahead;
}

} // namespace dicot::matching
