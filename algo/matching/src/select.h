// From aggregated costs to a disparity: winner-take-all (eq. 14), parabola (eq. 15), left-right check, confidence.
#pragma once

#include "cost_rows.h"
#include "dicot/base/disparity.h"

#include <span>

namespace dicot::matching {

/// How a pixel came to its disparity.
enum class Verdict : std::uint8_t
{
    kUnseen,     ///< no partner inside the right picture, or nothing matched on one side of it in its row
    kMismatched, ///< the right picture's winner disagrees, or a rival is as good
    kVoted,      ///< most of its neighbours have this disparity
    kMatched
};

/// The results of one row.
struct SelectedRow
{
    std::span<DispQ8> disparity; ///< relative, with sub-pixel part; kDispMissing without a candidate
    std::span<std::uint8_t> confidence;
    std::span<Verdict> verdict;
};

/// Scratch of one worker: the winners of a row, seen from the left picture and from the right one.
class Selector
{
public:
    void lay_out(Arena& arena, const Scene& scene);
    /// With `check`, verdicts come from the left-right check and the rival's cost; else every pixel with a candidate is
    /// matched.
    void select(const Scene& scene, AggregatedRow costs, bool check, SelectedRow& to);

private:
    std::span<Winner> winners_;
    std::span<std::uint16_t> right_cost_; ///< [width + axis - 1], from column -(axis - 1) of the search frame
    std::span<std::uint16_t> right_position_;
};

} // namespace dicot::matching
