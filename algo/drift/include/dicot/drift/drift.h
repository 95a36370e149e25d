// How far the rows of a rectified pair have come apart since its cameras were calibrated.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/disparity.h"
#include "dicot/base/image.h"
#include "dicot/base/status.h"

#include <cstddef>
#include <cstdint>

namespace dicot {

/// The epipolar residual of one pair: y_right - y_left of points that the matcher found in both pictures, in px of the
/// rectified picture. A rig that is as it was calibrated has a residual of 0 everywhere: what is seen in a row of the
/// left picture lies in the same row of the right one (Hartley and Zisserman, Multiple View Geometry, 11.12).
///
/// 0.1 px is excellent, 0.25 px still does; beyond that matches are lost. A camera that pitched raises the median, one
/// that rolled gives a slope over x, one whose focal length changed a slope over y. A camera that *yawed* leaves the
/// rows aligned: it moves disparities, so depth, and is not seen here.
struct EpipolarDrift
{
    /// With fewer points nothing below is known, and all of it is 0.
    static constexpr int kFewestPoints = 40;

    int points = 0; ///< measured to a fraction of a pixel
    int tried = 0;  ///< textured and matched, at most kMostPoints
    bool known() const { return points >= kFewestPoints; }

    double median_px = 0; ///< above 0: the right camera looks too high
    double spread_px = 0; ///< median of the absolute deviations from the median
    /// How fast the residual grows to the right in the right picture, px a px: the tangent of the angle by which the
    /// right camera is turned counterclockwise, seen from behind.
    double slope_x = 0;
    double slope_y = 0; ///< and downwards: by how much the right camera sees things larger

    /// The largest absolute residual that median and slopes make in a corner of the picture.
    double corner_px = 0;

    static constexpr int kMostPoints = 500;
    /// Residuals beyond this are not looked for.
    static constexpr int kReachPx = 3;
};

/// What measure_drift() takes from its arena for pictures of this size: two and a half bytes a pixel at most, and
/// less than a picture of Rgb8 has from 24 x 24 px on.
std::size_t drift_scratch_bytes(int width, int height) noexcept;

/// Compares a rectified pair by the disparities that were found in it. One textured place is taken in each cell of a
/// grid, found again in the right picture by least squares over a window of 13 x 13 px (Lucas and Kanade 1981, along
/// both axes, brightness and contrast free), and dropped if it is not found well. The arena is given back as it was.
/// Error of the median: below 0.05 px with 100 points and more, 0.1 px with fewer. The same pair gives the same figures
/// on every CPU.
///
/// Errors: kBadData for pictures and a map of different sizes; kConfig when the arena is too small.
Result<EpipolarDrift> measure_drift(ImageView<const Rgb8> left, ImageView<const Rgb8> right, const DisparityMap& map,
                                    Arena& scratch);

} // namespace dicot
