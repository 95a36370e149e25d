// Crossings joined into the lattice of a chessboard.
#pragma once

#include "saddle.h"

#include <compare>
#include <map>
#include <vector>

namespace dicot::calibration {

struct Cell
{
    int i = 0;
    int j = 0;
    friend auto operator<=>(const Cell&, const Cell&) = default;
};

/// One crossing in its lattice; `u` and `v` are unit vectors along growing i and j.
struct Node
{
    Point2 at;
    Point2 u;
    Point2 v;
    bool bright = false; ///< the sector between u and v is a bright one
    double contrast = 0;
};

using Lattice = std::map<Cell, Node>;

/// Whether rows and columns run straight in even steps, as those of a board do. Crossings of texture and noise join up
/// too, but bend.
bool lies_straight(const Lattice& lattice);

/// All straight lattices, each crossing in at most one, largest first. Growth stops at `max_side` nodes in a row; once
/// a lattice of `whole_nodes` is there, much paler crossings start no further ones.
std::vector<Lattice> grow_lattices(const GreyLevel& level, const std::vector<Saddle>& saddles, std::size_t whole_nodes,
                                   int max_side);

struct Extent
{
    int i0 = 0, i1 = 0, j0 = 0, j1 = 0; ///< both ends included
};
Extent extent_of(const Lattice& lattice);

} // namespace dicot::calibration
