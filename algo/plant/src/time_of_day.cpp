#include "time_of_day.h"

#include <algorithm>
#include <cmath>

namespace dicot::growth {

Daily daily_regressors(double hour)
{
    Daily row{};
    if (!std::isfinite(hour))
        return row;
    const double turned = hour - 24 * std::floor(hour / 24);
    const double place = turned / 24 * kKnots;
    const int knot = std::min(static_cast<int>(place), kKnots - 1);
    const double f = place - knot;
    const double weights[3] = {(1 - f) * (1 - f) / 2, 0.5 + f - f * f, f * f / 2};
    for (int k = 0; k < 3; ++k) {
        const int at = (knot + k) % kKnots;
        for (int i = 0; i < kDaily; ++i)
            row[static_cast<std::size_t>(i)] += at == i ? weights[k] : at == kDaily ? -weights[k] : 0;
    }
    return row;
}

double clock_distance(double a, double b)
{
    const double apart = std::abs(a - b);
    return std::min(apart, 24 - apart);
}

} // namespace dicot::growth
