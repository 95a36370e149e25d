#include "dicot/plant/canopy.h"
#include "frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace dicot {
namespace {

constexpr double kBinMm = 2;
constexpr int kBins = 300;
constexpr int kReach = 2;        ///< bins to either side that a plane's points fill
constexpr double kAboveMm = 30;  ///< of the bench: no pot is as low, saucers are
constexpr double kAcrossMm = 80; ///< of the canopy's middle: half a pot, where the plant is small
constexpr int kLeast = 150;      ///< points

/// Where the canopy is, from above: its middle and how far its points lie from there; and how high it is: soil is not
/// above three quarters of it.
struct Stand
{
    double right_mm = 0, away_mm = 0, reach_mm = 0, high_mm = 0;
};

double quantile_of(std::span<double> values, double share)
{
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

Stand stand_of(const PlantView& view, const Canopy& canopy, int plant, const GroundFrame& ground,
               std::span<double> values)
{
    const auto each = [&](double share, const auto& figure) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < canopy.plant.size() && count < values.size(); i += 3)
            if (canopy.plant[i] == plant)
                values[count++] = figure(in_ground(ground, point_mm(view, i)));
        return count > 0 ? quantile_of(values.first(count), share) : HUGE_VAL;
    };
    Stand stand;
    stand.right_mm = each(0.5, [](const Vec3& at) { return at.x; });
    stand.away_mm = each(0.5, [](const Vec3& at) { return at.y; });
    stand.high_mm = each(0.75, [](const Vec3& at) { return at.z; });
    stand.reach_mm = std::max(kAcrossMm, each(0.5, [&](const Vec3& at) {
                                  const double x = at.x - stand.right_mm, y = at.y - stand.away_mm;
                                  return std::sqrt(x * x + y * y);
                              }));
    return stand;
}

/// How high a point lies, if the surface there lies flat: neighbours four pixels away on either side are as high,
/// within what the slope of a tenth and noise make.
double flat_height(const PlantView& view, const GroundFrame& ground, int x, int y)
{
    constexpr int kApart = 4;
    const auto at = [&](int u, int v) {
        const std::int32_t i = view.point.at(u, v);
        return i == PlantView::kNoPoint ? Vec3{NAN, NAN, NAN}
                                        : in_ground(ground, point_mm(view, static_cast<std::size_t>(i)));
    };
    const Vec3 here = at(x, y), across = at(x + kApart, y) - at(x - kApart, y),
               along = at(x, y + kApart) - at(x, y - kApart);
    const Vec3 normal = cross(across, along);
    constexpr double kFlat = 0.9;
    return std::fabs(normal.z) > kFlat * length(normal) ? here.z : NAN;
}

} // namespace

void stand_on_soil(const PlantView& view, const Canopy& canopy, GroundFrame& ground, Arena& arena)
{
    if (ground.kind != GroundFrame::Kind::kBench || canopy.plant_count == 0)
        return;
    const std::size_t mark = arena.used();
    const std::span<double> values = arena.take<double>(view.cloud.points.size() / 3 + 1);
    const std::span<std::int32_t> held = arena.take<std::int32_t>(kBins);
    const std::span<double> heights = arena.take<double>(kBins);
    if (arena.overrun())
        return;
    std::ranges::fill(held, 0);
    std::ranges::fill(heights, 0.0);
    constexpr int kMargin = 4;
    for (int plant = 1; plant <= canopy.plant_count; ++plant) {
        const Stand stand = stand_of(view, canopy, plant, ground, values);
        for (int y = kMargin; y < view.point.height - kMargin; ++y)
            for (int x = kMargin; x < view.point.width - kMargin; ++x) {
                const std::int32_t i = view.point.at(x, y);
                if (i == PlantView::kNoPoint || canopy.plant[static_cast<std::size_t>(i)] != 0)
                    continue;
                const Vec3 at = in_ground(ground, point_mm(view, static_cast<std::size_t>(i)));
                const double right = at.x - stand.right_mm, away = at.y - stand.away_mm;
                if (!(at.z > kAboveMm && at.z < kBins * kBinMm) ||
                    right * right + away * away > stand.reach_mm * stand.reach_mm)
                    continue;
                const double height = flat_height(view, ground, x, y);
                if (!(height > 0 && height < std::min(stand.high_mm, kBins * kBinMm)))
                    continue;
                const auto bin = static_cast<std::size_t>(height / kBinMm);
                ++held[bin];
                heights[bin] += height;
            }
    }
    int most = 0;
    double soil_mm = 0;
    for (int bin = kReach; bin < kBins - kReach; ++bin) {
        int count = 0;
        double sum = 0;
        for (int near = bin - kReach; near <= bin + kReach; ++near) {
            count += held[static_cast<std::size_t>(near)];
            sum += heights[static_cast<std::size_t>(near)];
        }
        if (count > most) {
            most = count;
            soil_mm = sum / count;
        }
    }
    if (most >= kLeast) {
        ground.kind = GroundFrame::Kind::kSoil;
        for (int axis = 0; axis < 3; ++axis)
            ground.origin_mm[axis] += soil_mm * ground.up[axis];
        ground.bench_mm = -soil_mm;
        ground.height_sd_mm = std::sqrt(ground.height_sd_mm * ground.height_sd_mm + kBinMm * kBinMm);
    }
    arena.rewind(mark);
}

} // namespace dicot
