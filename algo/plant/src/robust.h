// Figures that a few wild values cannot turn.
#pragma once

#include <cstddef>
#include <span>

namespace dicot {

/// Of a normal distribution: its standard deviation over its median absolute deviation.
inline constexpr double kSdOfMedianDeviation = 1.4826;

/// Reorders `values`, which are not empty; the upper one of two in the middle.
double median_of(std::span<double> values);

struct LinePoint
{
    double x = 0, y = 0;
};

/// At `x`, the line whose slope and height are repeated medians (A. F. Siegel: Robust regression using repeated
/// medians, 1982): half of the points may be anywhere. 2 points at least, 16 at most.
double repeated_median_line(std::span<const LinePoint> points, double x);

} // namespace dicot
