// What happens to the whole map after the winners are known.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/disparity.h"
#include "dicot/base/work.h"
#include "planes.h"
#include "select.h"
#include "tables.h"

namespace dicot::matching {

/// A picture-sized map of the matcher.
struct Maps
{
    ImageView<DispQ8> disparity;
    ImageView<DispQ8> scratch;
    ImageView<std::uint8_t> confidence;
    ImageView<Verdict> verdict;
};

/// Takes away what failed a check.
void drop_unmatched(const Maps& maps);

/// Rows without any value copy the nearest row that has one; a map without any is all 0. A row has all values or none.
void fill_empty_rows(ImageView<DispQ8> map);

/// Gives every pixel a value: rows are filled from the smaller of the two nearest matched neighbours (the farther
/// surface, which is the one that is hidden). A filled pixel has confidence 0.
void fill_gaps(const Maps& maps);

/// Medians after filling: 5 x 5 for what was matched, colour-weighted for what was filled.
void smooth(const Maps& maps, const Planes& left, const ColourWeights& weights, Crew& crew);

/// The 3 x 3 median of all values.
void smooth_evenly(const Maps& maps, Crew& crew);

} // namespace dicot::matching
