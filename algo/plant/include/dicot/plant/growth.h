// One trait of one plant over the days: a smooth curve with its band, the time of day apart from it, outliers named.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/status.h"
#include "dicot/plant/traits.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

struct GrowthSample
{
    double day = 0;    ///< since any origin, the same for all; in any order
    double hour = 0;   ///< of the plant's own day, 0 .. 24; NaN: not known
    Measured measured; ///< NaN: passed over. An sd of 0 or NaN: not known
};

struct GrowthRules
{
    double longest_bridge_days = 0; ///< between two samples that a curve goes over; 0: 2 days, or 3 usual spacings
    int curve_points = 200;         ///< from the first sample to the last, 2 at least
};

struct SampleFit
{
    enum class Use : std::uint8_t
    {
        kUsed,
        kOutlier, ///< the curve is made without it
        kUnmeasured
    };

    Use use = Use::kUnmeasured;
    Measured expected; ///< growth and time of day together
    double miss = 0;   ///< from what the others say, in standard deviations of such misses
};

struct GrowthPoint
{
    double day = 0;
    Measured value; ///< NaN in an interval without samples that is longer than what is bridged
    Measured rate_per_day;
    Measured relative_rate_per_day; ///< rate / value; NaN where the value is not above 0
};

/// The spans are of the arena.
struct GrowthFit
{
    static constexpr int kHours = 24;

    std::span<SampleFit> samples;       ///< in the order of the samples
    std::span<GrowthPoint> curve;       ///< in the order of time; empty without a sample
    bool daily_known = false;           ///< whether there are days enough with several times of day
    std::array<Measured, kHours> daily; ///< what is added at hour 0, 1, ..; 0 on the mean of the samples. NaN: no
                                        ///< sample within two hours of it
    int used = 0;
    int outliers = 0;
    double sd_factor = 1; ///< by how much samples scatter more than their sd says, 1 at least; NaN: no sd was given
    double longest_bridge_days = 0;
};

/// What fit_growth() takes of an arena.
std::size_t growth_bytes(std::size_t samples, const GrowthRules& rules);

/// value = growth(day) + daily(hour) + noise: growth is a cubic smoothing spline, as smooth as restricted likelihood
/// has it (G. Wahba: Improper priors, spline smoothing and the problem of guarding against model errors in regression,
/// 1978; computed as a state space model, R. Kohn and C. F. Ansley: A new algorithm for spline smoothing based on
/// smoothing a stochastic process, 1987, so that band and rate come with it); daily a periodic quadratic spline, fitted
/// together with it. The band has the samples' sd in it, and more where they scatter more. A sample is an outlier where
/// it misses the curve of the others by far more than others do (median absolute deviation), found over again without
/// the outliers. Fault::kSoftware: the arena is too small.
Result<GrowthFit> fit_growth(std::span<const GrowthSample> samples, const GrowthRules& rules, Arena& arena);

} // namespace dicot
