#include "dicot/aiming/views.h"

#include "common_geometry.h"
#include "follow.h"
#include "levels.h"
#include "patches.h"

#include <algorithm>
#include <cmath>

namespace dicot::aiming {
namespace {

struct Bench
{
    Levels left, right;
    PatchTable patches;
    std::span<Sight> sights;
};

Bench lay_out(Grey left, Grey right, Arena& arena)
{
    Bench bench;
    bench.left = make_levels(left, arena);
    bench.right = make_levels(right, arena);
    bench.patches = PatchTable::lay_out(arena, bench.left);
    bench.sights = arena.take<Sight>(PatchTable::most_pairs(bench.left));
    return bench;
}

/// Degrees of a small slope; the series is exact to 0.002 degrees up to 10 degrees.
double degrees(double slope)
{
    constexpr double kDegrees = 57.295779513082320877;
    return kDegrees * (slope - slope * slope * slope / 3);
}

int overlap_percent(double shift_px, double rise_px, Grey picture)
{
    const double across = std::max(0.0, 1 - std::fabs(shift_px) / picture.width);
    const double down = std::max(0.0, 1 - std::fabs(rise_px) / picture.height);
    return static_cast<int>(100 * across * down + 0.5);
}

/// Shares of the width: what is no shift yet, how far the cameras may be turned towards each other before one pair
/// cannot tell any more, and a shift that only near things have.
constexpr double kClearShift = 1.0 / 160;
constexpr double kToeIn = 1.0 / 60;
constexpr double kNearShift = 1.0 / 40;

/// Whether shifts are above 0, given those of far and of near things: near things alone may decide if what is far
/// shifts the other way by little.
bool shifts_up(double far_px, double near_px, double width_px)
{
    if (far_px > kClearShift * width_px)
        return true;
    return near_px > kNearShift * width_px && far_px > -kToeIn * width_px && near_px > -2 * far_px;
}

Order order_of(std::span<Sight> sights, const Geometry& geometry, double width_px)
{
    // So many matches are not chance any more; what is near may be small in the picture.
    const std::size_t near = std::max<std::size_t>(5, sights.size() / 40), far = std::max(near, sights.size() / 20);
    const auto lowest = [&](std::size_t rank) { return ranked_shift(sights, geometry, rank); };
    const auto highest = [&](std::size_t rank) { return ranked_shift(sights, geometry, sights.size() - 1 - rank); };
    if (shifts_up(lowest(far), highest(near), width_px))
        return Order::kAsNamed;
    if (shifts_up(-highest(far), -lowest(near), width_px))
        return Order::kSwapped;
    return Order::kNotKnown;
}

} // namespace

std::size_t view_scratch_bytes(int width, int height) noexcept
{
    Arena measuring;
    const Grey nothing{nullptr, width, height};
    lay_out(nothing, nothing, measuring);
    return measuring.peak();
}

Result<Views> compare_views(Grey left, Grey right, Arena& scratch)
{
    if (!left.same_size(right))
        return failure(Fault::kBadData, "the pictures have %d x %d and %d x %d pixels: both cameras need one mode",
                       left.width, left.height, right.width, right.height);
    for (const int side : {left.width, left.height})
        if (side < kMinViewSide || side > kMaxViewSide)
            return failure(Fault::kBadData, "pictures of %d x %d pixels cannot be compared: each side must be %d to %d",
                           left.width, left.height, kMinViewSide, kMaxViewSide);
    if (const std::size_t need = view_scratch_bytes(left.width, left.height); scratch.size() < scratch.used() + need)
        return failure(Fault::kConfig, "comparing two pictures of %d x %d pixels needs %zu bytes, and %zu are free",
                       left.width, left.height, need, scratch.size() - std::min(scratch.size(), scratch.used()));
    const std::size_t mark = scratch.used();
    Bench bench = lay_out(left, right, scratch);

    Views views;
    std::size_t seen = 0;
    for (const Pair& pair : find_pairs(bench.left, bench.right, bench.patches))
        if (const std::optional<Sight> sight = follow(bench.left, bench.right, pair))
            bench.sights[seen++] = *sight;
    views.patches = bench.patches.patches;

    Geometry geometry;
    const std::size_t agreeing = agree(bench.sights.first(seen), left.width, Views::kFewestMatches, geometry);
    views.matches = static_cast<int>(agreeing);
    if (views.known()) {
        const std::span<Sight> sights = bench.sights.first(agreeing);
        views.shift_px = ranked_shift(sights, geometry, agreeing / 2);
        views.shift_low_px = ranked_shift(sights, geometry, agreeing / 10);
        views.shift_high_px = ranked_shift(sights, geometry, agreeing - 1 - agreeing / 10);
        views.vertical_px = geometry.rise_px;
        views.roll_deg = -degrees(geometry.slope);
        views.overlap_percent = overlap_percent(views.shift_px, views.vertical_px, left);
        views.order = order_of(sights, geometry, left.width);
    }
    scratch.rewind(mark);
    return views;
}

const char* name_of(Order order) noexcept
{
    switch (order) {
    case Order::kAsNamed:
        return "as named";
    case Order::kSwapped:
        return "swapped";
    case Order::kNotKnown:
        break;
    }
    return "not known";
}

} // namespace dicot::aiming
