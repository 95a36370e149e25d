#include "error_trend.h"

#include "../calibrate/report_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace dicot::app {
namespace {

constexpr std::size_t kLeastPoints = 4;
constexpr double kLeastSpread = 1.1; // farthest to nearest

/// What a cause of size 1 makes of a disparity, px: too small is above 0, as what is measured is then too far.
double shape(Trend trend, const TrendPoint& point, double depth_px_mm)
{
    switch (trend) {
    case Trend::kSame:
        return depth_px_mm / (point.distance_mm * point.distance_mm);
    case Trend::kScale:
        return depth_px_mm / point.distance_mm;
    case Trend::kWhole:
        return std::sin(2 * std::numbers::pi * point.disparity_px);
    default:
        return 1;
    }
}

} // namespace

ErrorTrend find_trend(std::span<const TrendPoint> points, double depth_px_mm)
{
    ErrorTrend best;
    if (points.size() < kLeastPoints)
        return best;
    const auto [near, far] = std::ranges::minmax(points, {}, &TrendPoint::distance_mm);
    if (far.distance_mm < kLeastSpread * near.distance_mm)
        return best;
    const double count = static_cast<double>(points.size());
    double all = 0;
    for (const TrendPoint& p : points)
        all += std::pow(p.error_mm * depth_px_mm / (p.distance_mm * p.distance_mm), 2);
    best.trend = Trend::kNone;
    best.left_px = std::sqrt(all / count);
    for (const Trend cause : std::array{Trend::kSame, Trend::kScale, Trend::kSquare, Trend::kWhole}) {
        double product = 0, square = 0;
        for (const TrendPoint& p : points) {
            const double px = p.error_mm * depth_px_mm / (p.distance_mm * p.distance_mm);
            const double m = shape(cause, p, depth_px_mm);
            product += px * m;
            square += m * m;
        }
        const double share = all > 0 ? product * product / square / all : 0;
        if (share <= best.explained)
            continue;
        best.explained = share;
        best.amount = product / square;
        best.trend = share >= kTrendShare && std::sqrt(all / count) > kQuietPx ? cause : Trend::kNone;
        best.left_px = std::sqrt(best.trend == Trend::kNone ? all / count : std::max(0.0, all * (1 - share) / count));
    }
    return best;
}

std::string sentence_of(const ErrorTrend& trend, double focal_px)
{
    const std::string rest = fill(" That is {} % of what is seen; the rest is {} px of disparity (RMS).",
                                  {fixed(100 * trend.explained, 0), fixed(trend.left_px, 3)});
    switch (trend.trend) {
    case Trend::kTooFew:
        return "Four targets at different distances or more would tell where the errors come from.";
    case Trend::kNone:
        return fill("No single cause over the distance stands out: what is seen is {} px of disparity (RMS), {}.",
                    {fixed(trend.left_px, 3),
                     trend.left_px <= kQuietPx ? "as little as a matcher can reach" : "the matcher's own error"});
    case Trend::kSame:
        return fill("Everything seems {} mm too {} at every distance: were the distances measured from the left "
                    "camera's projection centre (some mm behind the front of its lens), along its axis?",
                    {fixed(std::abs(trend.amount), 2), trend.amount > 0 ? "far" : "near"}) +
               rest;
    case Trend::kScale:
        return fill("Everything seems {} % too {}: the baseline or the focal length is off by as much; the usual "
                    "cause is the side of the board's squares, as it was given to the calibration.",
                    {fixed(100 * std::abs(trend.amount), 2), trend.amount > 0 ? "far" : "near"}) +
               rest;
    case Trend::kSquare:
        return fill("The error grows with the square of the distance, as if every disparity were {} px too {}: the "
                    "cameras have turned towards each other or apart by {} degrees since the calibration, or it was "
                    "not better than that.",
                    {fixed(std::abs(trend.amount), 3), trend.amount > 0 ? "small" : "large",
                     fixed(std::atan(std::abs(trend.amount) / focal_px) * 180 / std::numbers::pi, 4)}) +
               rest;
    case Trend::kWhole:
        return fill("Disparities are pulled {} whole pixels, by {} px where they lie a quarter between two: neither "
                    "the calibration nor the distances are to blame, but the matcher's step from whole px to parts.",
                    {trend.amount > 0 ? "towards" : "away from", fixed(std::abs(trend.amount), 3)}) +
               rest;
    }
    return "";
}

} // namespace dicot::app
