// Where the errors of a depth experiment come from, as far as a fit over the distance tells.
#pragma once

#include <span>
#include <string>

namespace dicot::app {

/// What one target gave.
struct TrendPoint
{
    double distance_mm = 0;
    double error_mm = 0;     ///< measured minus true
    double disparity_px = 0; ///< the true one
};

enum class Trend
{
    kTooFew, ///< less than four distances, or all within a tenth
    kNone,   ///< no one cause explains kTrendShare of what is seen, or that is less than kQuietPx
    kSame,   ///< the same at all distances: they were measured from another place than the projection centre
    kScale,  ///< in proportion to the distance: a wrong baseline or focal length
    kSquare, ///< in proportion to its square: every disparity is off by the same
    kWhole,  ///< over the disparity's fraction: what is matched is pulled towards whole px
};

/// A cause is named when it explains this share of the squared errors at least.
inline constexpr double kTrendShare = 0.6;
/// Errors (RMS, as disparities) that no matcher is much better than: nothing to look for.
inline constexpr double kQuietPx = 0.03;

struct ErrorTrend
{
    Trend trend = Trend::kTooFew;
    double amount = 0;    ///< kSame: mm; kScale: share of the distance; kSquare: px that disparities are too small;
                          ///< kWhole: px at a quarter between two whole ones
    double explained = 0; ///< share of the squared errors, 0 .. 1, of the cause that explains most
    double left_px = 0;   ///< RMS of what it does not explain, px of disparity
};

/// Fits each cause alone, by least squares in px of disparity (errors of matching are alike there at all distances).
/// `depth_px_mm` = focal length in px times baseline in mm: an error of e mm at Z mm is e * depth_px_mm / Z^2 px.
ErrorTrend find_trend(std::span<const TrendPoint> points, double depth_px_mm);

/// For a person, in one or two sentences; `focal_px` tells what the px are as an angle.
std::string sentence_of(const ErrorTrend& trend, double focal_px);

} // namespace dicot::app
