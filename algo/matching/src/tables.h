// The tables that a match looks things up in, made once from the options.
#pragma once

#include "dicot/kernels/kernels.h"
#include "dicot/matching/matcher.h"

namespace dicot::matching {

/// exp(-|p - q| / gamma_color), Q15, by the squared distance's position in the table (see kColourSteps).
struct ColourWeights
{
    std::uint16_t table[kColourTableAllocation];

    void fill(double gamma_color);
    /// The weight between pixel i of one row and pixel j of another.
    std::uint16_t between(LabRow p, int i, LabRow q, int j) const;
};

/// exp(-|(dx, dy)| / gamma_space) for dx, dy in -radius .. radius, row by row: left in Q15, right in Q14.
void fill_spatial_weights(std::uint16_t* left, std::uint16_t* right, int radius, double gamma_space);

/// Eq. 10 to 12, scaled from 0 .. 2 to 0 .. kCostMax; or eq. 9, scaled from 0 .. its threshold.
void fill_costs(CostTables& tables, MatchCost cost);

} // namespace dicot::matching
