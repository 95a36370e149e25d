#include "dicot/drift/drift.h"

#include "places.h"
#include "refind.h"
#include "resistant_plane.h"

#include <algorithm>
#include <cmath>

namespace dicot {
namespace {

struct Desk
{
    ImageView<std::uint8_t> left, right;
    std::span<drift::Sight> sights;
    std::span<double> values;
};

Desk lay_out(Arena& arena, int width, int height)
{
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    Desk desk;
    desk.left = {arena.take<std::uint8_t>(pixels).data(), width, height};
    desk.right = {arena.take<std::uint8_t>(pixels).data(), width, height};
    const drift::Cells cells = drift::cells_of(width, height);
    const std::size_t most = static_cast<std::size_t>(cells.columns) * static_cast<std::size_t>(cells.rows);
    desk.sights = arena.take<drift::Sight>(most);
    desk.values = arena.take<double>(most);
    return desk;
}

/// Luma of BT.601.
void to_grey(ImageView<const Rgb8> colour, ImageView<std::uint8_t> grey)
{
    for (int y = 0; y < colour.height; ++y) {
        const Rgb8* const from = colour.row(y);
        std::uint8_t* const to = grey.row(y);
        for (int x = 0; x < colour.width; ++x)
            to[x] = static_cast<std::uint8_t>((77 * from[x].r + 150 * from[x].g + 29 * from[x].b + 128) / 256);
    }
}

EpipolarDrift measure(const Desk& desk, const DisparityMap& map)
{
    EpipolarDrift drift;
    const drift::Cells cells = drift::cells_of(map.relative.width, map.relative.height);
    std::size_t found = 0;
    for (int row = 0; row < cells.rows; ++row)
        for (int column = 0; column < cells.columns; ++column) {
            const auto place = drift::textured_place(desk.left, map, cells, column, row);
            if (!place)
                continue;
            ++drift.tried;
            if (const auto sight = drift::refind(desk.left, desk.right, *place))
                desk.sights[found++] = *sight;
        }
    drift.points = static_cast<int>(found);
    if (!drift.known())
        return drift;
    const drift::Plane plane = drift::resistant_plane(desk.sights.first(found), desk.values);
    drift.median_px = plane.median;
    drift.spread_px = plane.spread;
    drift.slope_x = plane.slope_x;
    drift.slope_y = plane.slope_y;
    const double right = map.relative.width - 1, bottom = map.relative.height - 1;
    drift.corner_px = std::max({std::fabs(plane.at(0, 0)), std::fabs(plane.at(right, 0)),
                                std::fabs(plane.at(0, bottom)), std::fabs(plane.at(right, bottom))});
    return drift;
}

} // namespace

std::size_t drift_scratch_bytes(int width, int height) noexcept
{
    Arena arena;
    (void)lay_out(arena, width, height);
    return arena.peak();
}

Result<EpipolarDrift> measure_drift(ImageView<const Rgb8> left, ImageView<const Rgb8> right, const DisparityMap& map,
                                    Arena& scratch)
{
    if (!left.same_size(right) || left.width != map.relative.width || left.height != map.relative.height ||
        left.width != map.confidence.width || left.height != map.confidence.height)
        return failure(Fault::kBadData, "drift: pictures and disparities of different sizes");
    const std::size_t mark = scratch.used();
    const Desk desk = lay_out(scratch, left.width, left.height);
    const bool fits = !scratch.overrun();
    scratch.rewind(mark);
    if (!fits)
        return failure(Fault::kConfig, "drift: the arena is too small for %d x %d px", left.width, left.height);
    to_grey(left, desk.left);
    to_grey(right, desk.right);
    return measure(desk, map);
}

} // namespace dicot
