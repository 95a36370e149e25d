#include "stillness.h"

#include <algorithm>

namespace dicot::app {

Stillness::Stillness(int width, int corners)
    : radius_px_(kRadius_px * std::max(1.0, static_cast<double>(width) / kRadiusWidth_px))
{
    left_.reserve(static_cast<std::size_t>(corners));
    right_.reserve(static_cast<std::size_t>(corners));
}

bool Stillness::near_first(std::span<const Point2> now, std::span<const Point2> first) const
{
    return std::ranges::equal(now, first, [this](const Point2& a, const Point2& b) {
        const double x = a.x - b.x;
        const double y = a.y - b.y;
        return x * x + y * y < radius_px_ * radius_px_;
    });
}

bool Stillness::see(std::span<const Point2> left, std::span<const Point2> right, std::int64_t at_us)
{
    const bool followed = pairs_ > 0 && at_us > last_us_ && at_us - last_us_ <= kLongestGapUs;
    last_us_ = at_us;
    if (followed && near_first(left, left_) && near_first(right, right_)) {
        ++pairs_;
        return pairs_ >= kFewestPairs && at_us - since_us_ >= kStillUs;
    }
    left_.assign(left.begin(), left.end());
    right_.assign(right.begin(), right.end());
    since_us_ = at_us;
    pairs_ = 1;
    return false;
}

} // namespace dicot::app
