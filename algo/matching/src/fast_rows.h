// Aggregated costs over two lines instead of a square: each pixel of the column gathers its own row first.
#pragma once

#include "cost_rows.h"

namespace dicot::matching {

/// How much farther a line reaches than the square window: its two spatial weights multiply to a city-block distance,
/// which is 4 / pi of the straight one on average, and the diagonal's pixels are few.
inline constexpr double kLineReach = 1.5;

/// A cell of a window: a pixel so many columns and rows from the centre, or one that does not count.
struct FastCell
{
    int dx, dy;
    bool in;
};

/// One worker's tables of the fast method. Equation 13 twice: along the row of each pixel, to whole cost steps, and
/// over those results down the column: 2 x 35 terms instead of 35 x 35. Both pictures' weights count, as in the square.
/// The first pass fills a ring as high as the window, so it is done once for each row of the picture.
class FastRows
{
public:
    void lay_out(Arena& arena, const Scene& scene);

    /// The next calls of row() start a new band: any row may follow.
    void restart();

    /// Aggregated costs of row y; rows of a band are asked for from top to bottom without gaps.
    AggregatedRow row(const Scene& scene, int y, MatchTimes& times, std::uint64_t (*now_ns)());

private:
    /// Support weights of all pixels of a row, both pictures.
    struct Weights
    {
        std::span<PairU16> left;  ///< [groups][left_stride]
        std::span<PairU16> right; ///< [groups][right_stride], from column -(axis - 1) of the search frame
    };
    void raw_costs(const Scene& scene, int y);
    /// The weights of a group's two cells, for all pixels of row y.
    void weigh(const Scene& scene, int y, int group, FastCell low, FastCell high, Weights& to);
    AggregateStrip strip_of(const Scene& scene, const Weights& weights, const PairU16* costs, int x, int pixels);
    void gather_row(const Scene& scene, int y);
    void gather_columns(const Scene& scene, int rows);
    AggregatedRow made_row(const Scene& scene, int k) const;

    /// Rows that the second pass makes from one walk through the ring: as many as leave all their windows in it.
    static constexpr int kRowsAtATime = 2;

    int groups_ = 0;
    int left_stride_ = 0;
    int right_stride_ = 0;
    int next_gathered_ = -1;                           ///< the row that the first pass does next
    int first_made_ = -1;                              ///< this row and the next are in raw_
    std::span<PairU16> ring_;                          ///< [width][groups][axis], whole cost steps
    std::span<PairU16> raw_;                           ///< [width + radius][axis]: of columns x - radius and x + 1;
                                                       ///< then made rows, [kRowsAtATime][width][axis] uint16
    Weights weights_[kRowsAtATime];                    ///< of the rows being made; before, of the row being gathered
    std::span<std::uint32_t> numerator_, denominator_; ///< [kStrip][axis]
    std::span<std::uint16_t> quotient_;                ///< [axis]
};

} // namespace dicot::matching
