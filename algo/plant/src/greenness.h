// How green a colour is, whatever the light's strength.
#pragma once

#include "dicot/base/image.h"

namespace dicot {

/// Excess green: (2 g - r - b) / (r + g + b), -1 .. 2; 0 of black.
inline double greenness(const Rgb8& colour)
{
    const int sum = colour.r + colour.g + colour.b;
    return sum > 0 ? double(3 * colour.g - sum) / sum : 0;
}

} // namespace dicot
