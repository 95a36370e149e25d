#include "robust.h"

#include <algorithm>
#include <array>

namespace dicot {

double median_of(std::span<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double repeated_median_line(std::span<const LinePoint> points, double x)
{
    constexpr std::size_t kMost = 16;
    std::array<double, kMost> slopes{}, medians{}, heights{};
    std::size_t counted = 0;
    for (const LinePoint& a : points) {
        std::size_t count = 0;
        for (const LinePoint& b : points)
            if (b.x != a.x)
                slopes[count++] = (b.y - a.y) / (b.x - a.x);
        if (count > 0)
            medians[counted++] = median_of(std::span{slopes}.first(count));
    }
    const double slope = counted > 0 ? median_of(std::span{medians}.first(counted)) : 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        heights[i] = points[i].y + slope * (x - points[i].x);
    return median_of(std::span{heights}.first(points.size()));
}

} // namespace dicot
