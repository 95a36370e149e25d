#include "dicot/plant/canopy.h"
#include "frame.h"
#include "green.h"
#include "groups.h"
#include "strays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace dicot {
namespace {

/// The canopy from above, in square cells.
struct TopView
{
    static constexpr int kMostAcross = 512;

    double cell_mm = 10;
    double right_mm = 0, away_mm = 0; ///< of the first cell's corner
    int width = 0, height = 0;

    std::size_t cell(const Vec3& at) const
    {
        const int x = static_cast<int>((at.x - right_mm) / cell_mm), y = static_cast<int>((at.y - away_mm) / cell_mm);
        return static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(std::clamp(x, 0, width - 1));
    }
    std::size_t cells() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

TopView top_view(const PlantView& view, const GroundFrame& ground, std::span<const std::uint8_t> green)
{
    TopView top;
    double least[2] = {HUGE_VAL, HUGE_VAL}, most[2] = {-HUGE_VAL, -HUGE_VAL};
    for (std::size_t i = 0; i < green.size(); ++i) {
        if (!green[i])
            continue;
        const Vec3 at = in_ground(ground, point_mm(view, i));
        least[0] = std::min(least[0], at.x);
        most[0] = std::max(most[0], at.x);
        least[1] = std::min(least[1], at.y);
        most[1] = std::max(most[1], at.y);
    }
    if (least[0] > most[0])
        return top;
    const double across = std::max(most[0] - least[0], most[1] - least[1]);
    top.cell_mm = std::max(top.cell_mm, across / (TopView::kMostAcross - 1));
    top.right_mm = least[0];
    top.away_mm = least[1];
    top.width = static_cast<int>((most[0] - least[0]) / top.cell_mm) + 1;
    top.height = static_cast<int>((most[1] - least[1]) / top.cell_mm) + 1;
    return top;
}

/// Joins cells with no more than kGapMm between them.
void join_cells(const TopView& top, std::span<const std::int32_t> held, Groups& groups)
{
    constexpr double kGapMm = 100;
    const int reach = std::max(1, static_cast<int>(kGapMm / top.cell_mm));
    for (int y = 0; y < top.height; ++y)
        for (int x = 0; x < top.width; ++x) {
            const std::int32_t here = y * top.width + x;
            if (held[static_cast<std::size_t>(here)] == 0)
                continue;
            for (int v = y; v <= std::min(y + reach, top.height - 1); ++v)
                for (int u = std::max(0, x - reach); u <= std::min(x + reach, top.width - 1); ++u)
                    if (held[static_cast<std::size_t>(v * top.width + u)] > 0)
                        groups.join(here, v * top.width + u);
        }
}

/// Numbers the groups that are large enough to be plants from left to right: [root] -> 1 .. n, else 0.
int number_plants(const TopView& top, std::span<const std::int32_t> held, Groups& groups, std::span<std::int32_t> size,
                  std::span<std::int32_t> column)
{
    constexpr int kLeastPoints = 200;
    constexpr double kLeastShare = 0.2;
    std::ranges::fill(size, 0);
    std::ranges::fill(column, 0);
    for (std::size_t cell = 0; cell < held.size(); ++cell) {
        const auto root = static_cast<std::size_t>(groups.root(static_cast<std::int32_t>(cell)));
        size[root] += held[cell];
        column[root] += held[cell] * static_cast<std::int32_t>(cell % static_cast<std::size_t>(top.width));
    }
    const double least = std::max(double(kLeastPoints), kLeastShare * *std::ranges::max_element(size));
    int count = 0;
    while (count < UINT8_MAX) {
        std::size_t next = held.size();
        double where = HUGE_VAL;
        for (std::size_t root = 0; root < held.size(); ++root)
            if (size[root] >= least && double(column[root]) / size[root] < where) {
                where = double(column[root]) / size[root];
                next = root;
            }
        if (next == held.size())
            break;
        size[next] = -++count;
    }
    for (std::int32_t& group : size)
        group = group < 0 ? -group : 0;
    return count;
}

} // namespace

Canopy find_canopy(const PlantView& view, const GroundFrame& ground, Arena& arena, bool with_strays)
{
    Canopy canopy;
    canopy.plant = arena.take<std::uint8_t>(view.cloud.points.size());
    const std::size_t mark = arena.used();
    if (arena.overrun())
        return canopy;
    find_green(view, ground, canopy.plant, arena);
    const TopView top = top_view(view, ground, canopy.plant);
    const std::span<std::int32_t> held = arena.take<std::int32_t>(top.cells());
    const std::span<std::int32_t> parent = arena.take<std::int32_t>(top.cells());
    const std::span<std::int32_t> number = arena.take<std::int32_t>(top.cells());
    const std::span<std::int32_t> column = arena.take<std::int32_t>(top.cells());
    if (!arena.overrun() && top.cells() > 0) {
        std::ranges::fill(held, 0);
        const auto cell_of = [&](std::size_t i) { return top.cell(in_ground(ground, point_mm(view, i))); };
        for (std::size_t i = 0; i < canopy.plant.size(); ++i)
            if (canopy.plant[i])
                ++held[cell_of(i)];
        Groups groups(parent);
        join_cells(top, held, groups);
        canopy.plant_count = number_plants(top, held, groups, number, column);
        for (std::size_t i = 0; i < canopy.plant.size(); ++i)
            if (canopy.plant[i]) {
                const std::int32_t root = groups.root(static_cast<std::int32_t>(cell_of(i)));
                const std::int32_t named = number[static_cast<std::size_t>(root)];
                canopy.plant[i] = static_cast<std::uint8_t>(named == 0 && with_strays ? UINT8_MAX : named);
            }
    }
    arena.rewind(mark);
    if (!with_strays)
        drop_strays(view, canopy, arena);
    return canopy;
}

void put_in_boxes(const PlantView& view, const GroundFrame& ground, std::span<const PlantBox> boxes, Canopy& canopy)
{
    canopy.plant_count = static_cast<int>(std::min<std::size_t>(boxes.size(), UINT8_MAX));
    for (std::size_t i = 0; i < canopy.plant.size(); ++i) {
        if (!canopy.plant[i])
            continue;
        const Vec3 at = in_ground(ground, point_mm(view, i));
        const auto held = boxes.first(static_cast<std::size_t>(canopy.plant_count));
        const auto box = std::ranges::find_if(held, [&](const PlantBox& b) { return b.holds({at.x, at.y, at.z}); });
        canopy.plant[i] = box == held.end() ? std::uint8_t{0} : static_cast<std::uint8_t>(box - held.begin() + 1);
    }
}

} // namespace dicot
