// Aggregated costs (eq. 13), one row of the picture at a time, in memory that does not grow with the height.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/kernels/kernels.h"
#include "dicot/matching/matcher.h"
#include "edges.h"
#include "near_window.h"
#include "planes.h"
#include "raw_costs.h"
#include "tables.h"

#include <span>

namespace dicot::matching {

/// What all workers share while they match one pair.
struct Scene
{
    const Kernels* kernels;
    Planes left;
    Planes right;
    RightEdges right_edges; ///< of kBest alone, else empty
    ColourWeights colour;
    std::span<std::uint16_t> left_spatial;  ///< [window][window], Q15
    std::span<std::uint16_t> right_spatial; ///< [window][window], Q14
    CostTables costs;
    int width;
    int height;
    int radius;        ///< of the window
    int farther;       ///< of kBest: disparities that are searched before those asked for, to know what lies beyond
    int disparities;   ///< as asked for, and the farther ones
    int axis;          ///< disparities, padded to whole vectors
    int min_disparity; ///< of the farthest
    bool near_window;  ///< mix the costs of a narrow window in; needs a radius of 3 at least
};

/// The aggregated costs of one row: [width][axis], index r = axis - 1 - d; kNoCandidate where there is no partner.
using AggregatedRow = std::span<std::uint16_t>;

/// The indices r of pixel x of which the partner lies in the right picture; empty when last < first.
struct Candidates
{
    int first, last;
};
Candidates candidates_of(const Scene& scene, int x);

inline LabRow moved(LabRow row, int columns)
{
    return {row.la + columns, row.b + columns};
}

/// One worker's tables: raw costs of as many rows as the window has, and the support weights of a strip of pixels.
class CostRows
{
public:
    /// Without raw costs of its own where all workers share them: the caller makes those, all that row() reads.
    void lay_out(Arena& arena, const Scene& scene, const RawCosts* shared = nullptr);

    /// As lay_out left it, after its memory has served something else.
    void clear();

    /// The next calls of row() start a new band: any row may follow.
    void restart() { next_cost_row_ = -1; }

    /// Aggregated costs of row y; rows of a band are asked for from top to bottom.
    AggregatedRow row(const Scene& scene, int y, MatchTimes& times, std::uint64_t (*now_ns)());

private:
    struct GroupRows;
    const RawCosts& raw() const { return shared_ ? *shared_ : own_; }
    GroupRows rows_of_group(const Scene& scene, int y, int group) const;
    void left_weights(const Scene& scene, int y, int x0, int count);
    void right_weights(const Scene& scene, int y, int first, int count, int at);
    void aggregate(const Scene& scene, int y, int x0, int count);
    void divide(const Scene& scene, int x0, int count);
    void mix_near(const Scene& scene, int y, int x0, int count);

    int groups_ = 0;
    int columns_ = 0;
    int right_stride_ = 0;
    int next_cost_row_ = -1;
    const RawCosts* shared_ = nullptr;
    RawCosts own_;
    std::span<PairU16> left_;                          ///< [groups][columns][kStrip]
    std::span<PairU16> right_;                         ///< [groups][columns][right_stride]
    std::span<std::uint32_t> numerator_, denominator_; ///< [kStrip][axis]
    std::span<std::uint16_t> row_;                     ///< [width][axis]
    std::span<std::uint16_t> near_row_;                ///< [axis]
    NearWindow near_;
};

} // namespace dicot::matching
