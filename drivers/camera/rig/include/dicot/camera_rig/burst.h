// One trustworthy pair of pictures out of a burst.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/image.h"
#include "dicot/camera_rig/frame_average.h"
#include "dicot/camera_rig/stereo_camera.h"

#include <cstddef>
#include <cstdint>

namespace dicot {

struct BurstRules
{
    int pairs = 8;                      ///< that are looked at, 1 .. FrameAverage::kMostPictures
    bool average = true;                ///< false: the pair with the least skew, as it is
    std::int64_t most_skew_us = 10'000; ///< not asked of cameras that stream one after the other
};

struct BurstFigures
{
    int pairs = 0; ///< that arrived
    int used = 0;  ///< within the skew, whole and decoded
    int beyond_skew = 0;
    int undecodable = 0;            ///< a JPEG may be damaged although its frame is whole
    std::int64_t skew_us = 0;       ///< of the pair that was kept: the sharpest one, or the nearest
    std::int64_t least_skew_us = 0; ///< by size, of all pairs
    std::int64_t left_start_us = 0; ///< of the pair that was kept
    std::int64_t right_start_us = 0;
    AverageFigures left, right;
};

/// The decoded work of a burst, out of an arena: four pictures' worth.
class Burst
{
public:
    Burst(Arena& arena, int width, int height, const BurstRules& rules) noexcept;

    /// Leaves the pair in `left` and `right`, pictures of the cameras' size. With an average, all pairs within the skew
    /// are in it, and the sharpest of them is what moving pixels come from, in both pictures from the same pair.
    /// Errors: those of StereoCamera::next(); Fault::kUnavailable: pictures of another size; no pair within the skew or
    /// none that could be decoded, with the figures.
    Result<BurstFigures> take(StereoCamera& camera, ImageView<Rgb8> left, ImageView<Rgb8> right);

private:
    bool is_better(const StereoFrames& frames, const BurstFigures& figures) noexcept;

    BurstRules rules_;
    FrameAverage left_average_;
    FrameAverage right_average_;
    ImageView<Rgb8> left_now_;
    ImageView<Rgb8> right_now_;
    std::uint64_t best_sharpness_ = 0;
};

} // namespace dicot
