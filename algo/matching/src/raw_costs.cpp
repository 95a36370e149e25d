#include "raw_costs.h"

#include "cost_rows.h"

#include <algorithm>

namespace dicot::matching {

void RawCosts::lay_out(Arena& arena, const Scene& scene, int rows)
{
    groups_ = (rows + 1) / 2;
    width_ = scene.width + 2 * scene.radius;
    costs_ = arena.take<PairU16>(static_cast<std::size_t>(groups_) * static_cast<std::size_t>(width_) *
                                 static_cast<std::size_t>(scene.axis));
}

void RawCosts::clear()
{
    std::fill(costs_.begin(), costs_.end(), PairU16{0, 0});
}

std::size_t RawCosts::at(const Scene& scene, int group, int x) const
{
    return (static_cast<std::size_t>(group) * static_cast<std::size_t>(width_) +
            static_cast<std::size_t>(scene.radius + x)) *
           static_cast<std::size_t>(scene.axis);
}

void RawCosts::make(const Scene& scene, int y)
{
    const int slot = y % (2 * groups_);
    PairU16* const row = costs_.data() + at(scene, slot / 2, 0);
    std::uint16_t* const half = slot % 2 == 0 ? &row->low : &row->high;
    CostRow right = scene.right.cost(y);
    const int back = scene.axis - 1;
    right = {right.red - back, right.green - back, right.blue - back, right.census - back};
    scene.kernels->match_cost(half, scene.width, scene.axis, scene.left.cost(y), right, scene.costs);
}

const PairU16* RawCosts::group(const Scene& scene, int group, int x) const
{
    return costs_.data() + at(scene, group, x);
}

} // namespace dicot::matching
