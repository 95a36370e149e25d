// How good a disparity map is, against ground truth.
#pragma once

#include "dicot/base/image.h"
#include "dicot/base/status.h"

#include <array>
#include <cstdint>

namespace dicot::app {

/// A value that is off by more than this is bad, px.
inline constexpr std::array<double, 4> kBadThresholdsPx = {0.5, 1, 2, 4};

/// What a map reaches over the judged pixels. Shares are 0 .. 1; errors are in px of the map.
struct MapJudgement
{
    std::int64_t judged = 0;                                 ///< pixels whose truth is known and which the mask counts
    std::int64_t valued = 0;                                 ///< of these, pixels with a disparity
    std::array<std::int64_t, kBadThresholdsPx.size()> bad{}; ///< off by more than the threshold, or without a disparity
    std::array<std::int64_t, kBadThresholdsPx.size()> wrong{}; ///< of these, those with a disparity
    double mean_error_px = 0; ///< mean absolute error where there is a disparity; 0 when there is none
    double rms_error_px = 0;  ///< root mean square error, likewise

    double density() const { return share(valued, judged); }
    double bad_share(std::size_t threshold) const { return share(bad[threshold], judged); }
    /// Of the pixels with a disparity.
    double wrong_share(std::size_t threshold) const { return share(wrong[threshold], valued); }

private:
    static double share(std::int64_t part, std::int64_t whole)
    {
        return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
    }
};

/// The pixel of a picture k times as large that lies on the centre of pixel `at`; for even k, the last one before it.
constexpr int centre_of(int at, int k)
{
    return at * k + (k - 1) / 2;
}

/// How many times larger `large` is than `small`, in both directions alike; 0 when it is no whole multiple.
int multiple_of(int small_width, int small_height, int large_width, int large_height);

/// Judges `map` against `truth`, whose sides are k times as long (multiple_of() is not 0): truth is taken at
/// centre_of() each pixel and divided by k. +infinity is a missing value in both. `mask`, unless empty, is as large as
/// the map or the truth, and white (255) where a pixel counts.
MapJudgement judge_map(ImageView<const float> map, ImageView<const float> truth, ImageView<const Rgb8> mask);

} // namespace dicot::app
