// Whether a board stands still before two cameras.
#pragma once

#include "dicot/base/stereo_rig.h"

#include <cstdint>
#include <span>
#include <vector>

namespace dicot::app {

/// A board that moves while it is taken is in one place in the first row of a picture and in another in the last one
/// (rolling shutter), and in a third in the other camera's. It stands still when no corner of either picture has left
/// a small circle for half a second, and for three pairs at least.
class Stillness
{
public:
    static constexpr std::int64_t kStillUs = 500'000;
    static constexpr int kFewestPairs = 3;
    /// After a longer gap nobody knows what the board did meanwhile. Cameras that stream one after the other, for want
    /// of bandwidth, take seconds for a pair.
    static constexpr std::int64_t kLongestGapUs = 10'000'000;
    /// Radius of the circle in a picture of 640 px or less; wider ones see the same movement in more pixels.
    static constexpr double kRadius_px = 0.5;
    static constexpr int kRadiusWidth_px = 640;

    /// For pictures of `width` px and boards of `corners` corners.
    Stillness(int width, int corners);

    /// A pair that shows the whole board in both pictures, and when it was taken. Returns whether the board stands
    /// still.
    bool see(std::span<const Point2> left, std::span<const Point2> right, std::int64_t at_us);
    /// A pair that does not.
    void lose() { pairs_ = 0; }

    /// Since when nothing moved, as of the last pair seen; 0 when it moved.
    std::int64_t still_us() const { return pairs_ > 0 ? last_us_ - since_us_ : 0; }

private:
    bool near_first(std::span<const Point2> now, std::span<const Point2> first) const;

    double radius_px_;
    std::vector<Point2> left_; ///< of the first pair of the stillness
    std::vector<Point2> right_;
    std::int64_t since_us_ = 0;
    std::int64_t last_us_ = 0;
    int pairs_ = 0; ///< that stand where the first one stood, with it
};

} // namespace dicot::app
