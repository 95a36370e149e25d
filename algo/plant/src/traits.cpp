#include "dicot/plant/traits.h"

#include "greenness.h"
#include "leaf_borders.h"
#include "leaf_shape.h"
#include "plant_shape.h"
#include "root_of_squares.h"
#include "visible_area.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dicot {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegrees = 180 / std::numbers::pi;
/// Shares that no noise explains: how far from a tape's way the middles of the sections run, and where a found leaf
/// ends; how much of a surface seen at a slant the matcher makes flatter. And how far, as an angle, the normal turns by
/// that and by `up`. From the whole leaves of the rendered plants.
constexpr double kOutlineSd = 0.10, kFlattenedSd = 0.16, kTiltSd = 0.01;
/// A leaf that something hides along less of its border is whole enough to be measured.
constexpr double kHiddenShare = 0.08, kCutShare = 0.03;

Result<Traits> take_traits(const Leaves& leaves, Arena& arena)
{
    Traits traits;
    traits.leaves = arena.take<LeafTraits>(static_cast<std::size_t>(leaves.leaf_count));
    traits.plants = arena.take<PlantTraits>(static_cast<std::size_t>(leaves.plant_count));
    if (arena.overrun())
        return failure(Fault::kConfig, "too little memory to measure %d leaves", leaves.leaf_count);
    std::ranges::fill(traits.leaves, LeafTraits{});
    std::ranges::fill(traits.plants, PlantTraits{});
    return traits;
}

void put(Vec3 from, double (&into)[3])
{
    into[0] = from.x;
    into[1] = from.y;
    into[2] = from.z;
}

struct Appearance
{
    double greenness = 0;
    double unsure = 0; ///< share
};

Appearance appearance(const PlantView& view, std::span<const SurfaceCell> cells)
{
    Appearance seen;
    for (const SurfaceCell& cell : cells) {
        const CloudPoint& point = view.cloud.points[static_cast<std::size_t>(cell.point)];
        seen.greenness += greenness(point.colour);
        seen.unsure += 1 - point.confidence / 255.0;
    }
    const double count = std::max<double>(1, double(cells.size()));
    return {seen.greenness / count, seen.unsure / count};
}

/// Where the petioles come from: the middle of the plant, seen from above.
struct Trunk
{
    Vec3 middle, up;

    double away_from(Vec3 point) const
    {
        const Vec3 from = point - middle;
        return length(from - dot(from, up) * up);
    }
    /// mm, more where the base is: it is nearer to the plant's middle, most leaves hang down from it, and lobes meet
    /// there. None of the three is true of all leaves.
    double base_at(const LeafShape::End& end, double length_mm) const
    {
        return dot(end.point, up) / 2 + (end.sinus ? length_mm / 2 : 0) - away_from(end.point);
    }
};

void measure_leaf(const PlantView& view, const Leaves& leaves, const LeafSurfaces& surfaces, const LeafBorder& border,
                  const Trunk& trunk, std::span<Place> places, LeafTraits& leaf)
{
    std::span<SurfaceCell> cells = surfaces.of(leaf.leaf);
    const LeafGaps& gaps = surfaces.gaps[static_cast<std::size_t>(leaf.leaf - 1)];
    leaf.points = static_cast<std::int64_t>(cells.size());
    leaf.hidden = border.behind > kHiddenShare * border.sides;
    leaf.cut = border.cut > kCutShare * border.sides;
    for (Measured* none : {&leaf.length_mm, &leaf.width_mm, &leaf.area_mm2, &leaf.inclination_deg, &leaf.azimuth_deg,
                           &leaf.curvature_per_m})
        *none = {kNone, kNone};
    if (cells.size() < kFewestCells)
        return;
    LeafShape shape = leaf_shape(cells, view.focal_px, places.first(cells.size()));
    cells = cells.first(shape.blade_cells);
    surfaces.blade[static_cast<std::size_t>(leaf.leaf - 1)] = static_cast<std::int32_t>(cells.size());
    const Appearance seen = appearance(view, cells);
    leaf.greenness = seen.greenness;
    const Vec3 up = vec3(leaves.ground.up);
    if (dot(shape.frame.normal, up) < 0) { // the upper side's
        shape.frame.normal = -1.0 * shape.frame.normal;
        shape.curvature_per_mm = -shape.curvature_per_mm;
    }
    const bool turned = trunk.base_at(shape.ends[1], shape.length_mm) > trunk.base_at(shape.ends[0], shape.length_mm);
    const Vec3 base = shape.ends[turned ? 1 : 0].point, tip = shape.ends[turned ? 0 : 1].point;
    const Vec3 points_to = (turned ? -1.0 : 1.0) * shape.frame.along;
    put(shape.frame.centre, leaf.centre_mm);
    put(base, leaf.base_mm);
    put(tip, leaf.tip_mm);

    const double cell_mm2 = shape.area_mm2 / double(cells.size());
    const double beside = gaps.beside_cells * cell_mm2;
    const double area = shape.area_mm2 + beside;
    const double scale = gaps.noise_mm / shape.frame.centre.z; // z wrong as a whole: everything is larger or smaller
    const double two = std::numbers::sqrt2;
    // Both ends, each off by a cell and by the noise of z; the scale; what a tape would do otherwise.
    const auto sd_along = [&](double value_mm, double spacing_mm, Vec3 direction) {
        const double ends = root_of_squares(two * spacing_mm, two * gaps.noise_mm * std::fabs(direction.z));
        return root_of_squares(ends, scale * value_mm, kOutlineSd * value_mm);
    };
    leaf.length_mm = {shape.length_mm, sd_along(shape.length_mm, shape.along_spacing_mm, shape.frame.along)};
    leaf.width_mm = {shape.width_mm, sd_along(shape.width_mm, shape.across_spacing_mm, shape.frame.across)};
    const double rim = shape.length_mm * std::max(shape.along_spacing_mm, shape.across_spacing_mm);
    leaf.area_mm2 = {area, root_of_squares(root_of_squares(2 * scale * area, rim, seen.unsure * area / 4), beside / 3,
                                           kFlattenedSd * area)};

    const double upright = std::min(1.0, dot(shape.frame.normal, up));
    const double tilt = root_of_squares(two * gaps.noise_mm / std::max(1.0, shape.width_mm),
                                        leaves.ground.height_sd_mm / std::max(1.0, shape.length_mm), kTiltSd);
    leaf.inclination_deg = {std::acos(upright) * kDegrees, tilt * kDegrees};
    const double to_right = dot(points_to, vec3(leaves.ground.right)),
                 to_back = dot(points_to, vec3(leaves.ground.away));
    const double level = root_of_squares(to_right, to_back);
    const double azimuth = std::atan2(to_back, to_right) * kDegrees;
    if (level > 0)
        leaf.azimuth_deg = {azimuth < 0 ? azimuth + 360 : azimuth,
                            std::min(180.0, root_of_squares(leaf.width_mm.sd, two * gaps.noise_mm) /
                                                std::max(1.0, level * shape.length_mm) * kDegrees)};
    leaf.curvature_per_m = {-1000 * shape.curvature_per_mm, 1000 * shape.curvature_sd_per_mm};
}

void sum_up(const PlantView& view, const Leaves& leaves, const LeafSurfaces& surfaces, const Traits& traits,
            PlantTraits& plant)
{
    double slant = 0, weight = 0, slant_variance = 0, whole = 0, pieces = 0;
    for (const LeafTraits& leaf : traits.leaves) {
        if (leaf.plant != plant.plant)
            continue;
        ++whole;
        pieces += leaf.hidden || leaf.cut;
        plant.cut |= leaf.cut;
        if (std::isnan(leaf.area_mm2.value))
            continue;
        weight += leaf.area_mm2.value;
        slant += leaf.area_mm2.value * leaf.inclination_deg.value;
        slant_variance += leaf.area_mm2.value * leaf.area_mm2.value * leaf.inclination_deg.sd * leaf.inclination_deg.sd;
    }
    plant.leaf_area_visible_mm2 = visible_area(view, leaves, surfaces, plant.plant);
    plant.inclination_mean_deg =
        weight > 0 ? Measured{slant / weight, std::sqrt(slant_variance) / weight} : Measured{kNone, kNone};
    plant.leaf_count = {whole, std::sqrt(pieces) / 2};
    const Measured& area = plant.leaf_area_visible_mm2;
    const double share = area.value > 0 ? area.sd / area.value : 0;
    plant.projected_area_mm2.sd = share * plant.projected_area_mm2.value;
    plant.hull_volume_mm3.sd = share * plant.hull_volume_mm3.value;
}

} // namespace

Result<Traits> measure_traits(const PlantView& view, const Leaves& leaves, Arena& arena, double far_mm)
{
    const Traits traits = TRY(take_traits(leaves, arena));
    const std::size_t mark = arena.used();
    const LeafSurfaces surfaces = leaf_surfaces(view, leaves, arena);
    const std::span<LeafBorder> borders = arena.take<LeafBorder>(static_cast<std::size_t>(leaves.leaf_count));
    const std::size_t shared = arena.used();
    const std::span<Place> places = arena.take<Place>(view.cloud.points.size());
    if (arena.overrun())
        return failure(Fault::kConfig, "too little memory to measure %d leaves", leaves.leaf_count);
    find_borders(view, leaves, far_mm, borders);
    for (int plant = 1; plant <= leaves.plant_count; ++plant) {
        Vec3 sum;
        double cells = 0;
        for (int leaf = 1; leaf <= leaves.leaf_count; ++leaf)
            if (leaves.plant_of_leaf[static_cast<std::size_t>(leaf - 1)] == plant)
                for (const SurfaceCell& cell : surfaces.of(leaf)) {
                    sum = sum + Vec3{cell.x, cell.y, cell.z};
                    ++cells;
                }
        const Trunk trunk{(1 / std::max(1.0, cells)) * sum, vec3(leaves.ground.up)};
        for (int leaf = 1; leaf <= leaves.leaf_count; ++leaf) {
            const auto at = static_cast<std::size_t>(leaf - 1);
            if (leaves.plant_of_leaf[at] != plant)
                continue;
            traits.leaves[at].leaf = leaf;
            traits.leaves[at].plant = plant;
            measure_leaf(view, leaves, surfaces, borders[at], trunk, places, traits.leaves[at]);
        }
    }
    arena.rewind(shared);
    for (PlantTraits& plant : traits.plants) {
        plant.plant = static_cast<int>(&plant - traits.plants.data()) + 1;
        measure_plant(view, leaves, surfaces, arena, plant);
        sum_up(view, leaves, surfaces, traits, plant);
    }
    if (arena.overrun())
        return failure(Fault::kConfig, "too little memory to measure %d plants", leaves.plant_count);
    arena.rewind(mark);
    return traits;
}

std::size_t traits_bytes(std::size_t points, int leaf_count, int plant_count)
{
    const auto leaves = static_cast<std::size_t>(leaf_count);
    Arena measure;
    (void)measure.take<LeafTraits>(leaves);
    (void)measure.take<PlantTraits>(static_cast<std::size_t>(plant_count));
    (void)measure.take<std::int32_t>(leaves + 1);
    (void)measure.take<LeafGaps>(leaves);
    (void)measure.take<std::int32_t>(leaves);
    (void)measure.take<SurfaceCell>(points);
    (void)measure.take<LeafBorder>(leaves);
    Arena places;
    (void)places.take<Place>(points);
    return measure.peak() + std::max(places.peak(), plant_shape_bytes(points));
}

} // namespace dicot
