#include "common_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dicot::aiming {
namespace {

/// How far sights may lie from the fit, as shares of the width: first from the median rise, at last.
constexpr double kFirstTolerance = 0.06;
constexpr double kLastTolerance = 0.008;

/// Least squares of rise over (1, x, y); false if the sights do not determine it.
bool fit(std::span<const Sight> sights, Geometry& geometry)
{
    std::array<std::array<double, 4>, 3> rows{};
    for (const Sight& sight : sights) {
        const std::array<double, 4> values{1, sight.x, sight.y, sight.rise_px};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                rows[i][j] += values[i] * values[j];
    }
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(rows[i][i] > 1e-6))
            return false;
        for (std::size_t k = i + 1; k < 3; ++k) {
            const double share = rows[k][i] / rows[i][i];
            for (std::size_t j = i; j < 4; ++j)
                rows[k][j] -= share * rows[i][j];
        }
    }
    geometry.stretch = rows[2][3] / rows[2][2];
    geometry.slope = (rows[1][3] - rows[1][2] * geometry.stretch) / rows[1][1];
    geometry.rise_px = (rows[0][3] - rows[0][2] * geometry.stretch - rows[0][1] * geometry.slope) / rows[0][0];
    return true;
}

double median_rise(std::span<Sight> sights)
{
    const auto middle = sights.begin() + static_cast<std::ptrdiff_t>(sights.size() / 2);
    std::nth_element(sights.begin(), middle, sights.end(),
                     [](const Sight& a, const Sight& b) { return a.rise_px < b.rise_px; });
    return middle->rise_px;
}

} // namespace

std::size_t agree(std::span<Sight> sights, double width_px, std::size_t fewest, Geometry& geometry)
{
    geometry = {};
    if (sights.empty() || sights.size() < fewest)
        return 0;
    geometry.rise_px = median_rise(sights);
    for (double share = kFirstTolerance;; share = std::max(share * 0.7, kLastTolerance)) {
        const double tolerance = share * width_px;
        const auto others = std::partition(sights.begin(), sights.end(), [&](const Sight& sight) {
            return std::fabs(sight.rise_px - geometry.rise_at(sight)) <= tolerance;
        });
        const std::size_t agreeing = static_cast<std::size_t>(others - sights.begin());
        Geometry next;
        if (agreeing < fewest || !fit(sights.first(agreeing), next)) {
            geometry = {};
            return 0;
        }
        geometry = next;
        if (share == kLastTolerance)
            return agreeing;
    }
}

double ranked_shift(std::span<Sight> sights, const Geometry& geometry, std::size_t rank)
{
    const auto shift = [&](const Sight& sight) { return sight.shift_px - geometry.slope * sight.y; };
    const auto there = sights.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(sights.begin(), there, sights.end(),
                     [&](const Sight& a, const Sight& b) { return shift(a) < shift(b); });
    return shift(*there);
}

} // namespace dicot::aiming
