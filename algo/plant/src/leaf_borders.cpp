#include "leaf_borders.h"

#include <algorithm>
#include <utility>

namespace dicot {

void find_borders(const PlantView& view, const Leaves& leaves, double far_mm, std::span<LeafBorder> borders)
{
    constexpr int kGap = 24;           // cells: behind something nearer many have no point
    constexpr double kInFront_mm = 6;  // more than the noise of two surfaces
    constexpr double kAtTheEnd_mm = 2; // of the working range
    constexpr int kRim = 2;            // cells: the matcher's window leaves some out
    const double step_mm = view.mm_per_step();
    const double near_mm = view.cloud.grid.origin[2] * step_mm;
    constexpr std::pair<int, int> kSides[] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    std::ranges::fill(borders, LeafBorder{});
    const auto point_at = [&](int column, int row) {
        return view.point.at(column, row) == PlantView::kNoPoint ? -1 : view.point.at(column, row);
    };
    for (int row = 0; row < view.point.height; ++row)
        for (int column = 0; column < view.point.width; ++column) {
            const std::int32_t point = point_at(column, row);
            if (point < 0 || leaves.leaf[static_cast<std::size_t>(point)] == Leaves::kNone)
                continue;
            const std::uint16_t leaf = leaves.leaf[static_cast<std::size_t>(point)];
            LeafBorder& border = borders[leaf - std::size_t{1}];
            const double z = view.cloud.points[static_cast<std::size_t>(point)].z * step_mm;
            for (const auto& [across, down] : kSides) {
                bool same = false, behind = false, outside = false;
                for (int i = 1; i <= kGap; ++i) {
                    const int c = column + i * across, r = row + i * down;
                    outside = c < 0 || r < 0 || c >= view.point.width || r >= view.point.height;
                    if (outside) {
                        outside = i <= kRim;
                        break;
                    }
                    const std::int32_t other = point_at(c, r);
                    if (other < 0)
                        continue;
                    same = leaves.leaf[static_cast<std::size_t>(other)] == leaf;
                    behind = z - view.cloud.points[static_cast<std::size_t>(other)].z * step_mm > kInFront_mm;
                    break;
                }
                if (same)
                    continue;
                ++border.sides;
                border.behind += behind;
                border.cut += outside || z < near_mm + kAtTheEnd_mm || (far_mm > 0 && z > far_mm - kAtTheEnd_mm);
            }
        }
}

} // namespace dicot
