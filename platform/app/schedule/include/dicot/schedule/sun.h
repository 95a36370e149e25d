// When the sun rises and sets.
//
// The equations of NOAA's solar calculator (gml.noaa.gov/grad/solcalc), which are those of J. Meeus, Astronomical
// Algorithms, 2nd ed. 1998, chapters 25 and 28. Within a minute of almanacs between 72 degrees north and south, ten at
// higher latitudes: there the sun skims the horizon.
#pragma once

#include <cstdint>
#include <optional>

namespace dicot::app {

enum class SunEvent
{
    kRise, ///< the upper limb at a flat horizon, with refraction: the centre 50' below it
    kSet,
};

/// Of the day number `solar_day` since 1970-01-01 that clocks of local mean time show at this longitude; so each day
/// has one of each at most, wherever the place is and whatever its zone. UTC, rounded to the minute. None: the sun does
/// not rise or set on this day. Degrees, north and east are positive.
std::optional<std::int64_t> sun_us(SunEvent event, std::int64_t solar_day, double latitude_deg,
                                   double longitude_deg) noexcept;

/// The day that local mean time shows at a longitude.
std::int64_t solar_day(std::int64_t utc_us, double longitude_deg) noexcept;

} // namespace dicot::app
