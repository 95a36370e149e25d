// A pass along the row over the aggregated costs: neighbours of one surface agree on their disparity.
#pragma once

#include "cost_rows.h"

namespace dicot::matching {

/// Scanline optimisation (Hirschmueller 2008, eq. 13, along the row only, both ways): a change of one pixel of
/// disparity between neighbours costs a small step, a larger one a large step, both an eighth of it across a colour
/// edge. One direction is kept while the other runs back over it, so it needs one more row of costs and no volume.
class ScanlinePass
{
public:
    void lay_out(Arena& arena, const Scene& scene);

    /// Replaces the costs of row y by the mean of both directions; kNoCandidate stays.
    void smooth(const Scene& scene, int y, std::span<std::uint16_t> costs);

private:
    std::span<std::uint16_t> forward_; ///< [width][axis]
    std::span<std::uint16_t> state_;   ///< [3][axis]: where paths begin, the path behind, and the one being made
};

} // namespace dicot::matching
