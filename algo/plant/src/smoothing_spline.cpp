#include "smoothing_spline.h"

#include "dicot/base/exact_math.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dicot::growth {
namespace {

/// What the columns have at a step.
Row regressors(const Step& step)
{
    Row row{1, step.time};
    std::ranges::copy(step.daily, row.begin() + 2);
    return row;
}

/// The sample and each column, less what was foretold.
std::array<double, kColumns + 1> innovations(const Step& step, const SmoothingSpline::Passing& passing, int columns)
{
    std::array<double, kColumns + 1> miss{};
    const Row row = regressors(step);
    for (int c = 0; c <= columns; ++c) {
        const auto at = static_cast<std::size_t>(c);
        miss[at] = (c == 0 ? step.value : row[at - 1]) - passing.level[at];
    }
    return miss;
}

} // namespace

bool SmoothingSpline::fit(std::span<const Step> steps, int columns, double wiggle, double daily_ridge,
                          bool noise_is_known)
{
    columns_ = columns;
    Passing now{};
    Row right{};
    double own = 0;
    double log_variances = 0;
    int samples = 0;
    for (Row& row : factor_)
        row.fill(0);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const double dt = i == 0 ? 0 : steps[i].time - steps[i - 1].time;
        for (int c = 0; c <= columns; ++c)
            now.level[c] += dt * now.slope[c];
        now.cov[0] += dt * (2 * now.cov[1] + dt * (now.cov[2] + dt * wiggle / 3));
        now.cov[1] += dt * (now.cov[2] + dt * wiggle / 2);
        now.cov[2] += dt * wiggle;
        now.variance = steps[i].noise > 0 ? now.cov[0] + steps[i].noise : 0;
        passing_[i] = now;
        if (now.variance == 0)
            continue;
        const auto miss = innovations(steps[i], now, columns);
        for (std::size_t a = 0; a < static_cast<std::size_t>(columns); ++a) {
            right[a] += miss[a + 1] * miss[0] / now.variance;
            for (std::size_t b = 0; b <= a; ++b)
                factor_[a][b] += miss[a + 1] * miss[b + 1] / now.variance;
        }
        own += miss[0] * miss[0] / now.variance;
        log_variances += exact_log(now.variance);
        ++samples;
        const double gain[2] = {now.cov[0] / now.variance, now.cov[1] / now.variance};
        for (int c = 0; c <= columns; ++c) {
            now.level[c] += gain[0] * miss[static_cast<std::size_t>(c)];
            now.slope[c] += gain[1] * miss[static_cast<std::size_t>(c)];
        }
        now.cov[2] -= gain[1] * now.cov[1];
        now.cov[1] -= gain[0] * now.cov[1];
        now.cov[0] -= gain[0] * now.cov[0];
    }
    for (std::size_t a = 2; a < static_cast<std::size_t>(columns); ++a)
        for (std::size_t b = 2; b <= a; ++b)
            factor_[a][b] += a == b ? 2 * daily_ridge : daily_ridge; // of all six weights alike
    return solve(right, own, log_variances, samples, noise_is_known);
}

bool SmoothingSpline::solve(Row right, double own, double log_variances, int samples, bool noise_is_known)
{
    const auto columns = static_cast<std::size_t>(columns_);
    for (std::size_t a = 0; a < columns; ++a) {
        const double diagonal = factor_[a][a];
        for (std::size_t b = 0; b <= a; ++b) {
            for (std::size_t k = 0; k < b; ++k)
                factor_[a][b] -= factor_[a][k] * factor_[b][k];
            if (b < a)
                factor_[a][b] /= factor_[b][b];
        }
        if (!(factor_[a][a] > 1e-12 * diagonal))
            return false;
        factor_[a][a] = std::sqrt(factor_[a][a]);
        log_variances += 2 * exact_log(factor_[a][a]);
    }
    double explained = 0;
    for (std::size_t a = 0; a < columns; ++a) {
        for (std::size_t k = 0; k < a; ++k)
            right[a] -= factor_[a][k] * right[k];
        right[a] /= factor_[a][a];
        explained += right[a] * right[a];
    }
    weights_.fill(0);
    for (std::size_t a = columns; a-- > 0;) {
        weights_[a] = right[a];
        for (std::size_t k = a + 1; k < columns; ++k)
            weights_[a] -= factor_[k][a] * weights_[k];
        weights_[a] /= factor_[a][a];
    }
    const int free = samples - std::min(columns_, 2);
    const double rest = std::max(own - explained, 1e-14 * own);
    noise_factor_ = free > 0 ? rest / free : std::numeric_limits<double>::quiet_NaN();
    if (noise_is_known)
        noise_factor_ = free > 0 ? std::max(1.0, noise_factor_) : 1;
    badness_ = log_variances;
    if (free > 0 && noise_factor_ > 0)
        badness_ += free * exact_log(noise_factor_) + rest / noise_factor_;
    return true;
}

double SmoothingSpline::form(const Row& a, const Row& b) const
{
    Row left = a, right = b;
    double sum = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(columns_); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            left[i] -= factor_[i][k] * left[k];
            right[i] -= factor_[i][k] * right[k];
        }
        left[i] /= factor_[i][i];
        right[i] /= factor_[i][i];
        sum += left[i] * right[i];
    }
    return sum;
}

Measured SmoothingSpline::daily_difference(const Daily& daily) const
{
    Row row{};
    double value = 0;
    for (std::size_t k = 0; k < kDaily; ++k) {
        row[k + 2] = daily[k];
        value += daily[k] * weights_[k + 2];
    }
    return {value, std::sqrt(noise_factor_ * form(row, row))};
}

void SmoothingSpline::smooth(std::span<const Step> steps, std::span<Smoothed> into) const
{
    std::array<double, kColumns + 1> pull_level{}, pull_slope{}; // what later samples ask of the state
    double press[3] = {0, 0, 0};
    for (std::size_t i = steps.size(); i-- > 0;) {
        const Passing& at = passing_[i];
        const double dt = i + 1 < steps.size() ? steps[i + 1].time - steps[i].time : 0;
        for (std::size_t c = 0; c <= static_cast<std::size_t>(columns_); ++c)
            pull_slope[c] += dt * pull_level[c];
        press[2] += dt * (2 * press[1] + dt * press[0]);
        press[1] += dt * press[0];
        if (at.variance > 0) {
            const auto miss = innovations(steps[i], at, columns_);
            const double gain[2] = {at.cov[0] / at.variance, at.cov[1] / at.variance};
            for (std::size_t c = 0; c <= static_cast<std::size_t>(columns_); ++c)
                pull_level[c] += miss[c] / at.variance - gain[0] * pull_level[c] - gain[1] * pull_slope[c];
            const double first[2] = {(1 - gain[0]) * press[0] - gain[1] * press[1],
                                     (1 - gain[0]) * press[1] - gain[1] * press[2]};
            press[0] = (1 - gain[0]) * first[0] - gain[1] * first[1] + 1 / at.variance;
            press[1] = first[1];
        }
        Row level = regressors(steps[i]); // less what the spline makes of each column
        Row slope{0, 1};
        Smoothed& out = into[i];
        out = {};
        for (std::size_t c = 0; c <= static_cast<std::size_t>(columns_); ++c) {
            const double l = at.level[c] + at.cov[0] * pull_level[c] + at.cov[1] * pull_slope[c];
            const double s = at.slope[c] + at.cov[1] * pull_level[c] + at.cov[2] * pull_slope[c];
            if (c == 0) {
                out.level = l;
                out.slope = s;
                continue;
            }
            level[c - 1] -= l;
            slope[c - 1] -= s;
            out.level += weights_[c - 1] * level[c - 1];
            out.slope += weights_[c - 1] * slope[c - 1];
        }
        const double to_level[2] = {at.cov[0] * press[0] + at.cov[1] * press[1],
                                    at.cov[0] * press[1] + at.cov[1] * press[2]};
        const double to_slope[2] = {at.cov[1] * press[0] + at.cov[2] * press[1],
                                    at.cov[1] * press[1] + at.cov[2] * press[2]};
        const double level_var = at.cov[0] - (to_level[0] * at.cov[0] + to_level[1] * at.cov[1]);
        const double both_cov = at.cov[1] - (to_level[0] * at.cov[1] + to_level[1] * at.cov[2]);
        const double slope_var = at.cov[2] - (to_slope[0] * at.cov[1] + to_slope[1] * at.cov[2]);
        out.level_var = noise_factor_ * (std::max(level_var, 0.0) + form(level, level));
        out.slope_var = noise_factor_ * (std::max(slope_var, 0.0) + form(slope, slope));
        out.both_cov = noise_factor_ * (both_cov + form(level, slope));
    }
}

} // namespace dicot::growth
