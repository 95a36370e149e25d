#include "dicot/schedule/sun.h"

#include <cmath>
#include <numbers>

namespace dicot::app {
namespace {

constexpr double kDayS = 86'400;
constexpr double kSecondsPerDegree = kDayS / 360;

constexpr double radians(double degrees) noexcept
{
    return degrees * (std::numbers::pi / 180);
}

struct Sun
{
    double declination_rad;
    double ahead_of_mean_s; ///< equation of time
};

/// The names and numbers of Meeus, in degrees.
Sun sun_at(double utc_s) noexcept
{
    const double t = (utc_s / kDayS + 2'440'587.5 - 2'451'545.0) / 36'525; // Julian centuries since J2000
    const double mean_longitude = std::fmod(280.46646 + t * (36'000.76983 + t * 0.0003032), 360);
    const double anomaly = radians(357.52911 + t * (35'999.05029 - t * 0.0001537));
    const double eccentricity = 0.016708634 - t * (0.000042037 + t * 0.0000001267);
    const double centre = std::sin(anomaly) * (1.914602 - t * (0.004817 + t * 0.000014)) +
                          std::sin(2 * anomaly) * (0.019993 - t * 0.000101) + std::sin(3 * anomaly) * 0.000289;
    const double node = radians(125.04 - 1934.136 * t);
    const double longitude = radians(mean_longitude + centre - 0.00569 - 0.00478 * std::sin(node));
    const double tilt_seconds = 21.448 - t * (46.815 + t * (0.00059 - t * 0.001813));
    const double tilt = radians(23 + (26 + tilt_seconds / 60) / 60 + 0.00256 * std::cos(node));

    const double y = std::tan(tilt / 2) * std::tan(tilt / 2);
    const double l = radians(mean_longitude);
    const double time = y * std::sin(2 * l) - 2 * eccentricity * std::sin(anomaly) +
                        4 * eccentricity * y * std::sin(anomaly) * std::cos(2 * l) - 0.5 * y * y * std::sin(4 * l) -
                        1.25 * eccentricity * eccentricity * std::sin(2 * anomaly);
    return {std::asin(std::sin(tilt) * std::sin(longitude)), time / radians(1) * kSecondsPerDegree};
}

} // namespace

std::optional<std::int64_t> sun_us(SunEvent event, std::int64_t solar_day, double latitude_deg,
                                   double longitude_deg) noexcept
{
    constexpr double kZenithDeg = 90.833;
    constexpr int kRounds = 4; // each asks where the sun is at the time that the one before has found
    const double latitude = radians(latitude_deg);
    const double mean_noon_s = (static_cast<double>(solar_day) + 0.5) * kDayS - longitude_deg * kSecondsPerDegree;
    double at_s = mean_noon_s;
    for (int round = 0; round < kRounds; ++round) {
        const Sun sun = sun_at(at_s);
        const double cosine = std::cos(radians(kZenithDeg)) / (std::cos(latitude) * std::cos(sun.declination_rad)) -
                              std::tan(latitude) * std::tan(sun.declination_rad);
        if (!(cosine >= -1 && cosine <= 1))
            return std::nullopt;
        const double half_day_s = std::acos(cosine) / radians(1) * kSecondsPerDegree;
        at_s = mean_noon_s - sun.ahead_of_mean_s + (event == SunEvent::kRise ? -half_day_s : half_day_s);
    }
    return static_cast<std::int64_t>(std::floor(at_s / 60 + 0.5)) * 60 * 1'000'000;
}

std::int64_t solar_day(std::int64_t utc_us, double longitude_deg) noexcept
{
    return static_cast<std::int64_t>(
        std::floor((static_cast<double>(utc_us) / 1e6 + longitude_deg * kSecondsPerDegree) / kDayS));
}

} // namespace dicot::app
