#include "resistant_plane.h"

#include <algorithm>
#include <cmath>

namespace dicot::drift {
namespace {

/// Enough for slopes of points that lie unevenly.
constexpr int kRounds = 8;

double median_of(std::span<double> values)
{
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 != 0 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

template <typename Figure>
double median(std::span<const Sight> sights, std::span<double> values, const Figure& figure)
{
    for (std::size_t i = 0; i < sights.size(); ++i)
        values[i] = figure(sights[i]);
    return median_of(values.first(sights.size()));
}

/// The slope along one axis of what the other slopes leave.
template <typename Place, typename Left>
double slope(std::span<Sight> sights, std::span<double> values, const Place& place, const Left& left)
{
    std::sort(sights.begin(), sights.end(), [&](const Sight& a, const Sight& b) {
        if (place(a) != place(b))
            return place(a) < place(b);
        if (a.y != b.y)
            return a.y < b.y;
        return a.x != b.x ? a.x < b.x : a.residual_px < b.residual_px;
    });
    const std::size_t third = sights.size() / 3;
    const auto low = sights.first(third), high = sights.last(third);
    const double run = median(high, values, place) - median(low, values, place);
    if (run <= 0)
        return 0;
    return (median(high, values, left) - median(low, values, left)) / run;
}

} // namespace

Plane resistant_plane(std::span<Sight> sights, std::span<double> values) noexcept
{
    Plane plane;
    plane.median = median(sights, values, [](const Sight& sight) { return sight.residual_px; });
    plane.spread =
        median(sights, values, [&](const Sight& sight) { return std::fabs(sight.residual_px - plane.median); });
    const auto left = [&](const Sight& sight) {
        return sight.residual_px - plane.slope_x * sight.x - plane.slope_y * sight.y;
    };
    for (int round = 0; round < kRounds; ++round) {
        plane.slope_x += slope(
            sights, values, [](const Sight& sight) { return sight.x; }, left);
        plane.slope_y += slope(
            sights, values, [](const Sight& sight) { return sight.y; }, left);
    }
    plane.at_origin = median(sights, values, left);
    return plane;
}

} // namespace dicot::drift
