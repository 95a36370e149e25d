// A smooth function around the clock, as what is added to a value by the hour.
#pragma once

#include <array>

namespace dicot::growth {

/// B-splines of second order around the clock, a knot every four hours. They add up to 1, so the last one's weight is
/// minus the sum of the others'.
inline constexpr int kKnots = 6;
inline constexpr int kDaily = kKnots - 1;

using Daily = std::array<double, kDaily>;

/// What the weights are multiplied with at an hour; NaN: all 0.
Daily daily_regressors(double hour);

/// Of two hours around the clock, 0 .. 12.
double clock_distance(double a, double b);

} // namespace dicot::growth
