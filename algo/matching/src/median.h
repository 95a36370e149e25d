// The plain median of a square window.
#pragma once

#include "dicot/base/disparity.h"

#include <algorithm>
#include <array>

namespace dicot::matching {

/// to[x] = the median of the window of (x, y) with 2 * kRadiusU + 1 rows and columns, as far as it lies in the map.
template <unsigned kRadiusU>
void median_row(ImageView<const DispQ8> from, int y, DispQ8* to)
{
    constexpr int kRadius = kRadiusU;
    std::array<DispQ8, (2 * kRadiusU + 1) * (2 * kRadiusU + 1)> values{};
    for (int x = 0; x < from.width; ++x) {
        std::size_t count = 0;
        for (int ny = std::max(y - kRadius, 0); ny <= std::min(y + kRadius, from.height - 1); ++ny)
            for (int nx = std::max(x - kRadius, 0); nx <= std::min(x + kRadius, from.width - 1); ++nx)
                values[count++] = from.row(ny)[nx];
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
        std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
        to[x] = *middle;
    }
}

} // namespace dicot::matching
