// A pair of cameras' pictures with parallel rows, and the way back from disparities to depths of the raw pixels.
#pragma once

#include "lent_arena.h"
#include "raw_depth.h"
#include "scenes.h"

#include "dicot/base/disparity.h"
#include "dicot/cloud/working_range.h"
#include "dicot/matching/matcher.h"
#include "dicot/rectification/rectify.h"
#include "dicot/rectification/rig_maps.h"

#include <vector>

namespace dicot::test {

/// The plants of rig-dev stand within it.
inline constexpr WorkingRange kWorkingRange{400, 1400};

/// Disparities in px from anybody, row after row; NaN where there is none.
struct Disparities
{
    int width = 0;
    int height = 0;
    std::vector<float> px;
    std::vector<std::uint8_t> confidence;
};

Disparities disparities_of(const DisparityMap& map);

class RectifiedView
{
public:
    explicit RectifiedView(const StereoRig& rig);

    const StereoRig& rig() const { return rig_; }
    const Rectification& flat() const { return flat_; }
    RigGeometry geometry() const;
    /// What is searched for kWorkingRange.
    DisparityRange range() const;
    MatchOptions options(MatchMethod method) const;

    scenes::Picture left(const scenes::Picture& raw) const { return remapped(maps_.left, raw); }
    scenes::Picture right(const scenes::Picture& raw) const { return remapped(maps_.right, raw); }

    /// A raw left pixel's depth is that of the nearest rectified pixel, if within kWorkingRange: what a cloud holds.
    RawDepth on_raw_pixels(const Disparities& disparities) const;
    /// Where a point of the left camera's frame stands in the rectified left picture, and its disparity.
    struct Seen
    {
        Point2 pixel;
        double disparity_px = 0;
    };
    Seen seen(const Point3& in_left) const;

private:
    static scenes::Picture remapped(const RemapTable& table, const scenes::Picture& raw);

    StereoRig rig_;
    Rectification flat_;
    LentArena memory_;
    RigMaps maps_;
    std::vector<std::int32_t> nearest_; ///< of each raw pixel: the rectified pixel's index, or -1
};

} // namespace dicot::test
