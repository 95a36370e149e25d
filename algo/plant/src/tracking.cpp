#include "dicot/plant/tracking.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace dicot {
namespace {

constexpr double kHandMm = 60;
constexpr double kMostGrowth = 4;
constexpr double kGrowthWeight = 0.1; // two leaves of the same place and direction differ in size at last

struct Pair
{
    double cost;
    std::int32_t known, seen;
};

double dot(const double (&a)[3], const double (&b)[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// `cost(known, seen)` is empty where both cannot be the same.
template <typename Seen, typename Cost>
Status match(std::span<const Seen> known, std::span<const Seen> seen, std::span<std::int32_t> known_of, Arena& scratch,
             Cost&& cost)
{
    const std::size_t mark = scratch.used();
    const std::span<Pair> room = scratch.take<Pair>(known.size() * seen.size());
    const std::span<std::uint8_t> taken = scratch.take<std::uint8_t>(known.size());
    if (scratch.overrun())
        return failure(Fault::kSoftware, "to match %zu with %zu needs %zu bytes", known.size(), seen.size(),
                       match_bytes(known.size(), seen.size()));
    std::size_t count = 0;
    for (std::size_t k = 0; k < known.size(); ++k)
        for (std::size_t s = 0; s < seen.size(); ++s)
            if (const std::optional<double> price = cost(known[k], seen[s]))
                room[count++] = {*price, static_cast<std::int32_t>(k), static_cast<std::int32_t>(s)};
    const std::span<Pair> pairs = room.first(count);
    std::ranges::sort(pairs, {}, [](const Pair& pair) { return std::tuple(pair.cost, pair.known, pair.seen); });
    std::ranges::fill(taken, std::uint8_t{0});
    std::ranges::fill(known_of, kNobody);
    for (const Pair& pair : pairs) {
        std::uint8_t& is_taken = taken[static_cast<std::size_t>(pair.known)];
        std::int32_t& whose = known_of[static_cast<std::size_t>(pair.seen)];
        if (is_taken != 0 || whose != kNobody)
            continue;
        is_taken = 1;
        whose = pair.known;
    }
    scratch.rewind(mark);
    return {};
}

/// Square of the distance of two upright lines.
double apart_squared(const PlantStand& a, const PlantStand& b)
{
    const double between[3] = {b.centre_mm[0] - a.centre_mm[0], b.centre_mm[1] - a.centre_mm[1],
                               b.centre_mm[2] - a.centre_mm[2]};
    const double height = dot(between, a.up);
    return dot(between, between) - height * height;
}

std::optional<double> leaf_cost(const LeafMark& known, const LeafMark& seen)
{
    const double large = std::max(known.area_mm2, seen.area_mm2);
    const double small = std::min(known.area_mm2, seen.area_mm2);
    const double between[3] = {seen.centre_mm[0] - known.centre_mm[0], seen.centre_mm[1] - known.centre_mm[1],
                               seen.centre_mm[2] - known.centre_mm[2]};
    const double moved = dot(between, between) / large;
    if (!(small > 0) || !(large <= kMostGrowth * small) || !(moved <= 1))
        return std::nullopt;
    const double lengths = dot(known.along, known.along) * dot(seen.along, seen.along);
    const double both = dot(known.along, seen.along);
    const double turned = lengths > 0 ? 1 - both * both / lengths : 0;
    return moved + kGrowthWeight * (large / small + small / large - 2) + turned;
}

} // namespace

void plant_stands(const PlantView& view, const Leaves& leaves, std::span<PlantStand> stands)
{
    const double mm = view.mm_per_step();
    for (std::size_t plant = 0; plant < stands.size(); ++plant) {
        PlantStand& stand = stands[plant];
        stand = {};
        std::copy_n(leaves.ground.up, 3, stand.up);
        double sums[3] = {}, squares = 0, along = 0, along_squares = 0, count = 0;
        for (std::size_t i = 0; i < leaves.plant.size(); ++i) {
            if (leaves.plant[i] != plant + 1)
                continue;
            const CloudPoint& point = view.cloud.points[i];
            const double at[3] = {point.x * mm, point.y * mm, point.z * mm};
            for (int axis = 0; axis < 3; ++axis)
                sums[axis] += at[axis];
            const double height = dot(at, stand.up);
            squares += dot(at, at);
            along += height;
            along_squares += height * height;
            ++count;
        }
        if (count == 0)
            continue;
        for (int axis = 0; axis < 3; ++axis)
            stand.centre_mm[axis] = sums[axis] / count;
        const double all = squares / count - dot(stand.centre_mm, stand.centre_mm);
        const double upright = along_squares / count - along / count * (along / count);
        stand.spread_mm = std::sqrt(std::max(all - upright, 0.0));
    }
}

LeafMark mark_of(const LeafTraits& leaf)
{
    LeafMark mark;
    for (int axis = 0; axis < 3; ++axis) {
        mark.centre_mm[axis] = leaf.centre_mm[axis];
        mark.along[axis] = leaf.tip_mm[axis] - leaf.base_mm[axis];
    }
    mark.area_mm2 = leaf.area_mm2.value;
    return mark;
}

Status match_plants(std::span<const PlantStand> known, std::span<const PlantStand> stands,
                    std::span<std::int32_t> known_of, Arena& scratch)
{
    return match(known, stands, known_of, scratch,
                 [](const PlantStand& a, const PlantStand& b) -> std::optional<double> {
                     const double reach = std::max({a.spread_mm, b.spread_mm, kHandMm});
                     const double apart = apart_squared(a, b);
                     return apart <= reach * reach ? std::optional{apart} : std::nullopt;
                 });
}

Status match_leaves(std::span<const LeafMark> known, std::span<const LeafMark> leaves, std::span<std::int32_t> known_of,
                    Arena& scratch)
{
    return match(known, leaves, known_of, scratch, leaf_cost);
}

std::size_t match_bytes(std::size_t known, std::size_t seen)
{
    Arena measure;
    (void)measure.take<Pair>(known * seen);
    (void)measure.take<std::uint8_t>(known);
    return measure.peak();
}

} // namespace dicot
