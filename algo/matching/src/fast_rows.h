// Aggregated costs over a row and a column instead of a square: each pixel of the column gathers its own row first.
#pragma once

#include "cost_rows.h"

namespace dicot::matching {

/// How much farther the two lines reach than the square: the product of their spatial weights falls with the city-block
/// distance, which is longer than the straight one.
inline constexpr double kLineReach = 1.5;

/// Rows between two cells of the column. Neighbours of the column then share no row, and the costs hold together by
/// the paths along the rows.
inline constexpr int kRowStep = 2;

/// A cell of a window: a pixel so many columns and rows from the centre, or one that does not count.
struct WindowCell
{
    int dx, dy;
    bool in;
};

/// One worker's tables of the fast method: equation 13 twice, first along the row of each pixel, to whole cost steps,
/// then over those results down the column, in every second row of the window: 35 + 17 terms instead of 35 x 35. Both
/// pictures' weights count both times, as in the square. The first pass is done once for each row of the picture and
/// kept in a ring as high as the window.
class FastRows
{
public:
    void lay_out(Arena& arena, const Scene& scene);

    /// The next calls of row() start a new band: any row may follow.
    void restart() { next_gathered_ = -1; }

    /// Aggregated costs of row y; rows of a band are asked for from top to bottom without gaps.
    AggregatedRow row(const Scene& scene, int y, MatchTimes& times, std::uint64_t (*now_ns)());

private:
    void raw_costs(const Scene& scene, int y);
    /// The support weights of a group's two cells, for all pixels of row y.
    void weigh(const Scene& scene, int y, int group, WindowCell low, WindowCell high);
    void row_weights(const Scene& scene, int y);
    void column_weights(const Scene& scene, int y);
    void gather_row(const Scene& scene, int y);
    void gather_columns(const Scene& scene, int y);
    AggregateStrip strip_of(const Scene& scene, const PairU16* costs, int x, int pixels, int groups);
    PairU16* ring_at(const Scene& scene, int x, int y);
    AggregatedRow made_row(const Scene& scene) const;

    int row_groups_ = 0;    ///< pairs of cells of the row: those from the left end to the centre, and right of it
    int column_groups_ = 0; ///< pairs of slots of the column
    int left_stride_ = 0;
    int right_stride_ = 0;
    int next_gathered_ = -1;                           ///< the row that the first pass does next
    std::span<PairU16> ring_;                          ///< [width][2: y even, odd][column groups][axis]
    std::span<PairU16> raw_;                           ///< [width + radius][axis]: of columns x - radius and x + 1;
                                                       ///< in its place then the row that is made, uint16 [width][axis]
    std::span<PairU16> left_;                          ///< [groups][left_stride]
    std::span<PairU16> right_;                         ///< [groups][right_stride], from column -(axis - 1)
    std::span<std::uint32_t> numerator_, denominator_; ///< [kStrip][axis]
    std::span<std::uint16_t> quotient_;                ///< [axis]
};

} // namespace dicot::matching
