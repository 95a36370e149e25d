// A cubic smoothing spline with regressors beside it, as a state space model: exact, and linear in time and memory.
#pragma once

#include "time_of_day.h"

#include "dicot/base/arena.h"
#include "dicot/plant/traits.h"

#include <array>
#include <cstddef>
#include <span>

namespace dicot::growth {

/// Level and slope at the first step, then the time of day.
inline constexpr int kColumns = 2 + kDaily;

using Row = std::array<double, kColumns>;

/// One time of the spline. Steps are in the order of time.
struct Step
{
    double time = 0;  ///< the first is at 0, the last at 1 or all at 0
    double value = 0; ///< of a sample
    double noise = 0; ///< its variance, but for the common factor; 0: no sample, only a place to know the curve at
    Daily daily{};    ///< its regressors; 0 where the time of day is left out
};

/// What is known of one step when all samples have been heard; the level together with the step's time of day.
struct Smoothed
{
    double level = 0, slope = 0;
    double level_var = 0, slope_var = 0, both_cov = 0;
};

/// Level and slope are unknown at the start; the second derivative is white noise of the variance `wiggle` a unit of
/// time, in units of the noise's common factor.
class SmoothingSpline
{
public:
    struct Passing
    {
        double variance;            ///< of the innovation; 0: no sample
        double cov[3];              ///< of the state, before the sample: level, both, slope
        double level[kColumns + 1]; ///< of the samples, then of each column
        double slope[kColumns + 1];
    };

    void lay_out(std::size_t steps, Arena& arena) { passing_ = arena.take<Passing>(steps); }

    /// Filters. `columns`: 1 (level), 2 (and slope), or all. `daily_ridge` holds the time of day where no sample tells.
    /// False: fewer samples than columns need, or columns that say the same.
    bool fit(std::span<const Step> steps, int columns, double wiggle, double daily_ridge, bool noise_is_known);

    /// Minus twice the restricted log likelihood, but for what does not depend on `wiggle`.
    double badness() const { return badness_; }
    /// By which the given variances are to be multiplied; at least 1 where they are known. NaN: nobody can say.
    double noise_factor() const { return noise_factor_; }
    /// `daily` is a difference of regressors, with one time of day and with another.
    Measured daily_difference(const Daily& daily) const;

    /// Backwards over the steps of the last fit().
    void smooth(std::span<const Step> steps, std::span<Smoothed> into) const;

private:
    bool solve(Row right, double own, double log_variances, int samples, bool noise_is_known);
    double form(const Row& a, const Row& b) const; ///< a' S^-1 b

    std::span<Passing> passing_;
    int columns_ = 0;
    double badness_ = 0;
    double noise_factor_ = 1;
    Row weights_{};
    std::array<Row, kColumns> factor_{}; ///< lower Cholesky factor of S
};

} // namespace dicot::growth
