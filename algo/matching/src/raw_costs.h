// Costs of single pixels (eq. 10), of as many rows as a window needs.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/kernels/kernels.h"

#include <span>

namespace dicot::matching {

struct Scene;

/// The rows made last: row y of the picture in slot y mod (2 groups), a group being the two halves of a pair.
class RawCosts
{
public:
    /// Room for `rows` rows in a row, and the columns that the window of the scene reaches beyond the picture.
    void lay_out(Arena& arena, const Scene& scene, int rows);

    /// Makes everything a cost, which weighs nothing where none is made: to be done before the first row.
    void clear();

    /// Makes row y in the place of an earlier one. Rows 2 i and 2 i + 1 are for the same worker.
    void make(const Scene& scene, int y);

    int groups() const { return groups_; }
    /// Of column x, from -radius to width + radius - 1, and all columns after it, [axis] each.
    const PairU16* group(const Scene& scene, int group, int x) const;

private:
    std::size_t at(const Scene& scene, int group, int x) const;

    int groups_ = 0;
    int width_ = 0;
    std::span<PairU16> costs_; ///< [groups][width + 2 radius][axis]
};

} // namespace dicot::matching
