#include "dicot/plant/plant_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>

namespace dicot {
namespace {

/// Where a point stands in a picture of focal length 1.
struct Direction
{
    double across, down;
};

Direction direction(const CloudPoint& point)
{
    return {double(point.x) / point.z, double(point.y) / point.z};
}

/// A regular row of places: origin + i * pitch.
struct Lattice
{
    double pitch = 0;
    double origin = 0;

    double index(double at) const { return (at - origin) / pitch; }
};

/// The pitch of pixels, to a hundredth. Of the steps from point to point within a row the short ones are single;
/// rounding to the grid of the cloud moves each by a tenth, and their mean by far less.
double rough_pitch(std::span<const CloudPoint> points, Arena& arena)
{
    constexpr std::size_t kEnough = 1 << 16, kFewAreSingle = 50;
    const std::size_t mark = arena.used();
    const std::span<double> steps = arena.take<double>(std::min(points.size(), kEnough));
    const std::size_t stride = points.size() / kEnough + 1;
    std::size_t count = 0;
    for (std::size_t i = 0; i + 1 < points.size() && count < steps.size(); i += stride) {
        const Direction here = direction(points[i]), next = direction(points[i + 1]);
        const double across = next.across - here.across;
        if (across > 0 && std::fabs(next.down - here.down) < across / 2)
            steps[count++] = across;
    }
    double pitch = 0;
    if (count > 0) {
        const auto end = steps.begin() + static_cast<std::ptrdiff_t>(count);
        const auto single = steps.begin() + static_cast<std::ptrdiff_t>(count / kFewAreSingle);
        std::nth_element(steps.begin(), single, end);
        const auto rest =
            std::partition(steps.begin(), end, [limit = 1.5 * *single](double step) { return step < limit; });
        pitch = std::accumulate(steps.begin(), rest, 0.0) / static_cast<double>(rest - steps.begin());
    }
    arena.rewind(mark);
    return pitch;
}

/// Whole steps are counted from each point to the next of its row, so that rows as a whole tell the pitch.
double exact_pitch(std::span<const CloudPoint> points, double rough)
{
    double way = 0, steps = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Direction here = direction(points[i]), next = direction(points[i + 1]);
        const double across = next.across - here.across;
        constexpr double kFar = 50; // a rough pitch may be wrong by a hundredth
        if (across <= 0 || across > kFar * rough || std::fabs(next.down - here.down) > rough / 2)
            continue;
        way += across;
        steps += std::floor(across / rough + 0.5);
    }
    return steps > 0 ? way / steps : 0;
}

/// Puts the origin onto the lattice near `first`, by the mean of what is left of every point.
template <typename Coordinate>
double lattice_origin(std::span<const CloudPoint> points, double pitch, double first, const Coordinate& coordinate)
{
    double left = 0;
    for (const CloudPoint& point : points) {
        const double index = (coordinate(point) - first) / pitch;
        left += index - std::floor(index + 0.5);
    }
    return first + pitch * left / double(points.size());
}

/// Share of the points that stand farther than a quarter of a step from the lattice.
template <typename Coordinate>
double off_lattice(std::span<const CloudPoint> points, const Lattice& lattice, const Coordinate& coordinate)
{
    std::size_t off = 0;
    for (const CloudPoint& point : points) {
        const double index = lattice.index(coordinate(point));
        off += std::fabs(index - std::floor(index + 0.5)) > 0.25;
    }
    return double(off) / double(points.size());
}

struct Extent
{
    double least = 0, most = 0;
};

template <typename Coordinate>
Extent extent_of(std::span<const CloudPoint> points, const Coordinate& coordinate)
{
    Extent extent{coordinate(points[0]), coordinate(points[0])};
    for (const CloudPoint& point : points) {
        extent.least = std::min(extent.least, coordinate(point));
        extent.most = std::max(extent.most, coordinate(point));
    }
    return extent;
}

int cell(const Lattice& lattice, double at)
{
    return static_cast<int>(std::floor(lattice.index(at) + 0.5));
}

Result<PlantView> without_grid(const PointCloud& cloud, Arena& arena)
{
    if (cloud.points.size() > PlantView::kFewPoints)
        return failure(Fault::kBadData, "the cloud's points are not one for each pixel of a picture");
    const std::span<std::int32_t> cell = arena.take<std::int32_t>(1);
    if (arena.overrun())
        return failure(Fault::kConfig, "too little memory to look at a cloud");
    cell[0] = PlantView::kNoPoint;
    PlantView view;
    view.cloud = cloud;
    view.point = {cell.data(), 1, 1};
    view.focal_px = 1;
    view.too_few = true;
    return view;
}

} // namespace

Result<PlantView> plant_view(const PointCloud& cloud, Arena& arena)
{
    const std::span<const CloudPoint> points = cloud.points;
    if (points.empty())
        return failure(Fault::kBadData, "the cloud has no points");
    if (std::ranges::any_of(points, [](const CloudPoint& point) { return point.z <= 0; }))
        return failure(Fault::kBadData, "the cloud has points behind the camera: its frame is not the left camera's");

    const auto across = [](const CloudPoint& point) { return direction(point).across; };
    const auto down = [](const CloudPoint& point) { return direction(point).down; };
    const double rough = rough_pitch(points, arena);
    if (arena.overrun())
        return failure(Fault::kConfig, "too little memory to look at a cloud");
    const double pitch = rough > 0 ? exact_pitch(points, rough) : 0;
    const Extent columns = extent_of(points, across), rows = extent_of(points, down);
    constexpr double kMostCells = PlantView::kMostCells;
    const double cells =
        pitch > 0 ? ((columns.most - columns.least) / pitch + 1) * ((rows.most - rows.least) / pitch + 1) : 0;
    if (cells <= 0 || cells > kMostCells)
        return without_grid(cloud, arena);

    Lattice column{pitch, lattice_origin(points, pitch, columns.least, across)};
    Lattice row{pitch, lattice_origin(points, pitch, rows.least, down)};
    constexpr double kMostOff = 0.05;
    if (off_lattice(points, column, across) > kMostOff || off_lattice(points, row, down) > kMostOff)
        return without_grid(cloud, arena);
    // The least coordinate may round to the cell before the first.
    column.origin += pitch * cell(column, columns.least);
    row.origin += pitch * cell(row, rows.least);

    PlantView view;
    view.cloud = cloud;
    view.focal_px = 1 / pitch;
    view.cx_px = -column.origin / pitch;
    view.cy_px = -row.origin / pitch;
    const int width = cell(column, columns.most) + 1, height = cell(row, rows.most) + 1;
    const std::span<std::int32_t> all =
        arena.take<std::int32_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    if (arena.overrun())
        return failure(Fault::kConfig, "too little memory to look at a cloud");
    std::ranges::fill(all, PlantView::kNoPoint);
    view.point = {all.data(), width, height};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Direction at = direction(points[i]);
        // The least one may lie on the border of two cells.
        std::int32_t& there = view.point.at(std::max(0, cell(column, at.across)), std::max(0, cell(row, at.down)));
        if (there == PlantView::kNoPoint || points[i].z < points[static_cast<std::size_t>(there)].z)
            there = static_cast<std::int32_t>(i);
    }
    return view;
}

} // namespace dicot
