// One camera alone.
#pragma once

#include "bundle.h"

#include <span>
#include <vector>

namespace dicot::calibration {

struct Sight
{
    const Board* board;
    std::span<const Point2> corners; ///< empty: not seen
};

struct LensFit
{
    LensVector lens = LensVector::Zero();
    std::vector<Pose> poses;    ///< by view; meaningless where the view was not seen
    std::vector<double> rms_px; ///< by view; 0 where not seen
    double median_rms_px = 0;
    double focal_deviation = 0; ///< relative standard deviation of the worse focal length
    double tilt_spread_deg = 0; ///< largest angle between two boards
};

/// Fits the lens to every seen view, robustly. At least one view must be seen.
LensFit fit_lens(std::span<const Sight> sights, int width, int height, bool fit_k3);

/// 1.4826 times the median of the absolute values: the standard deviation of what is mostly normal.
double robust_deviation(std::vector<double> values);
double median(std::vector<double> values);
/// The angle of a cosine in degrees.
double degrees_of_cosine(double cosine);

} // namespace dicot::calibration
