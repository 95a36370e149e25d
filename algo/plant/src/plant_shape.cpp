#include "plant_shape.h"

#include "dicot/plant/convex_hull.h"
#include "greenness.h"
#include "root_of_squares.h"
#include "vec3.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace dicot {
namespace {

constexpr double kRaster_mm = 4;
/// A plant that spans more has larger cells.
constexpr int kMostAcross = 400;

/// One leaf's cells of the picture may fall into a cell of the raster by a quarter more than their share.
constexpr double kTwice = 1.25;

struct RasterCell
{
    float covered_mm2 = 0;
    float lowest_mm = std::numeric_limits<float>::max();
    float highest_mm = -std::numeric_limits<float>::max();
    float x_mm[2] = {0, 0}, y_mm[2] = {0, 0}; ///< where the lowest and the highest stand
};

struct Memory
{
    std::span<float> heights;
    std::span<RasterCell> raster;
    std::span<GridPoint> extremes;
};

Memory lay_out(std::size_t points, Arena& arena)
{
    constexpr std::size_t kCells = std::size_t{kMostAcross} * kMostAcross;
    return {arena.take<float>(points), arena.take<RasterCell>(kCells),
            arena.take<GridPoint>(2 * std::min(kCells, points))};
}

struct Reach
{
    double least_x = std::numeric_limits<double>::max(), most_x = -least_x, least_y = least_x, most_y = -least_x;

    void take_in(Vec3 at)
    {
        least_x = std::min(least_x, at.x);
        most_x = std::max(most_x, at.x);
        least_y = std::min(least_y, at.y);
        most_y = std::max(most_y, at.y);
    }
};

class Ground
{
public:
    explicit Ground(const GroundFrame& frame)
        : origin_(vec3(frame.origin_mm)), right_(vec3(frame.right)), away_(vec3(frame.away)), up_(vec3(frame.up))
    {
    }
    Vec3 place(Vec3 in_camera) const
    {
        const Vec3 from = in_camera - origin_;
        return {dot(from, right_), dot(from, away_), dot(from, up_)};
    }

private:
    Vec3 origin_, right_, away_, up_;
};

/// The least of the highest `count`.
double highest(std::span<float> heights, std::size_t count)
{
    const auto at = heights.begin() +
                    static_cast<std::ptrdiff_t>(heights.size() - std::clamp<std::size_t>(count, 1, heights.size()));
    std::nth_element(heights.begin(), at, heights.end());
    return *at;
}

void measure_heights(std::span<float> heights, double ground_sd_mm, PlantTraits& plant)
{
    const std::size_t n = heights.size();
    const double p999 = highest(heights, n / 1000), p985 = highest(heights, n * 15 / 1000),
                 p995 = highest(heights, n / 200);
    plant.height_p99_mm = {highest(heights, n / 100), root_of_squares(ground_sd_mm, (p995 - p985) / 2)};
    const double top = highest(heights, static_cast<std::size_t>(PlantTraits::kHighest));
    plant.height_max_mm = {top, root_of_squares(ground_sd_mm, std::fabs(top - p999) / 2)};
    const std::size_t tenth = std::max<std::size_t>(1, n / 10);
    (void)highest(heights, tenth);
    double sum = 0, squares = 0;
    for (const float height : heights.last(tenth)) {
        sum += height;
        squares += double(height) * height;
    }
    const double mean = sum / double(tenth);
    constexpr double kAlone = 100; // cells: neighbours of one surface are no new witnesses
    const double spread = std::sqrt(std::max(0.0, squares / double(tenth) - mean * mean));
    plant.height_top10_mean_mm = {
        mean, root_of_squares(ground_sd_mm, spread / std::sqrt(std::max(1.0, double(tenth) / kAlone)))};
}

} // namespace

void measure_plant(const PlantView& view, const Leaves& leaves, const LeafSurfaces& surfaces, Arena& arena,
                   PlantTraits& plant)
{
    const std::size_t mark = arena.used();
    const Memory memory = lay_out(view.cloud.points.size(), arena);
    if (arena.overrun())
        return;
    const Ground ground(leaves.ground);
    const double step_mm = view.mm_per_step();
    const auto each_point = [&](const auto& visit) {
        for (std::size_t i = 0; i < view.cloud.points.size(); ++i)
            if (leaves.plant[i] == plant.plant) {
                const CloudPoint& p = view.cloud.points[i];
                visit(ground.place({p.x * step_mm, p.y * step_mm, p.z * step_mm}), i);
            }
    };
    std::size_t on_leaves = 0;
    Reach reach;
    double green = 0;
    each_point([&](Vec3 at, std::size_t i) {
        ++plant.points;
        if (leaves.leaf[i] != Leaves::kNone) // others may be strays
            memory.heights[on_leaves++] = static_cast<float>(at.z);
        reach.take_in(at);
        green += greenness(view.cloud.points[i].colour);
    });
    if (plant.points == 0) { // a place where nothing grows has no height
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        for (Measured* none : {&plant.height_max_mm, &plant.height_p99_mm, &plant.height_top10_mean_mm})
            *none = {kNone, kNone};
        arena.rewind(mark);
        return;
    }
    plant.greenness = green / double(plant.points);
    if (on_leaves == 0)
        each_point([&](Vec3 at, std::size_t) { memory.heights[on_leaves++] = static_cast<float>(at.z); });
    measure_heights(memory.heights.first(on_leaves), leaves.ground.height_sd_mm, plant);

    const double span = std::max(reach.most_x - reach.least_x, reach.most_y - reach.least_y);
    const double cell_mm = std::max(kRaster_mm, span / (kMostAcross - 1));
    const int width = static_cast<int>((reach.most_x - reach.least_x) / cell_mm) + 1;
    const int height = static_cast<int>((reach.most_y - reach.least_y) / cell_mm) + 1;
    const auto raster = memory.raster.first(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    std::ranges::fill(raster, RasterCell{});
    const auto cell_at = [&](Vec3 at) -> RasterCell& {
        const int column = std::clamp(static_cast<int>((at.x - reach.least_x) / cell_mm), 0, width - 1);
        const int row = std::clamp(static_cast<int>((at.y - reach.least_y) / cell_mm), 0, height - 1);
        return raster[static_cast<std::size_t>(row * width + column)];
    };
    each_point([&](Vec3 at, std::size_t) {
        RasterCell& cell = cell_at(at);
        const auto h = static_cast<float>(at.z), x = static_cast<float>(at.x), y = static_cast<float>(at.y);
        if (h < cell.lowest_mm) {
            cell.lowest_mm = h;
            cell.x_mm[0] = x;
            cell.y_mm[0] = y;
        }
        if (h > cell.highest_mm) {
            cell.highest_mm = h;
            cell.x_mm[1] = x;
            cell.y_mm[1] = y;
        }
    });
    for (int leaf = 1; leaf <= leaves.leaf_count; ++leaf)
        if (leaves.plant_of_leaf[static_cast<std::size_t>(leaf - 1)] == plant.plant)
            for (const SurfaceCell& cell : surfaces.blade_of(leaf))
                cell_at(ground.place({cell.x, cell.y, cell.z})).covered_mm2 += cell.from_above_mm2;

    double projected = 0;
    std::size_t extremes = 0;
    // The hull counts in steps of the cloud's grid, or in coarser ones where the plant reaches farther than those
    // count.
    const double grid_mm = std::max(step_mm, 2 * span / kHullReach);
    const auto on_grid = [&](double mm) {
        return static_cast<std::int32_t>(
            std::clamp(std::floor(mm / grid_mm + 0.5), -double(kHullReach), double(kHullReach)));
    };
    for (const RasterCell& cell : raster) {
        const double whole = cell_mm * cell_mm;
        projected += cell.covered_mm2 > kTwice * whole ? whole : cell.covered_mm2;
        if (cell.highest_mm < cell.lowest_mm)
            continue;
        for (std::size_t i = 0; i < 2; ++i)
            memory.extremes[extremes++] = {on_grid(cell.x_mm[i] - reach.least_x), on_grid(cell.y_mm[i] - reach.least_y),
                                           on_grid(i == 0 ? cell.lowest_mm : cell.highest_mm)};
    }
    plant.projected_area_mm2.value = projected;
    const auto six_volumes = static_cast<double>(hull_volume_x6(memory.extremes.first(extremes), arena));
    plant.hull_volume_mm3.value = six_volumes / 6 * grid_mm * grid_mm * grid_mm;
    arena.rewind(mark);
}

std::size_t plant_shape_bytes(std::size_t points)
{
    Arena measure;
    (void)lay_out(points, measure);
    constexpr std::size_t kCells = std::size_t{kMostAcross} * kMostAcross;
    return measure.peak() + hull_bytes(2 * std::min(kCells, points));
}

} // namespace dicot
