// Independent deviations, added.
#pragma once

#include <cmath>

namespace dicot {

inline double root_of_squares(double a, double b, double c = 0)
{
    return std::sqrt(a * a + b * b + c * c);
}

} // namespace dicot
