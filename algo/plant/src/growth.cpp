#include "dicot/plant/growth.h"

#include "robust.h"
#include "smoothing_spline.h"
#include "time_of_day.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dicot {
namespace {

using growth::clock_distance;
using growth::Daily;
using growth::daily_regressors;
using growth::kDaily;
using growth::Smoothed;
using growth::SmoothingSpline;
using growth::Step;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kCurveStep = SIZE_MAX;
constexpr int kRounds = 8;             // in which outliers settle
constexpr double kOutlierAt = 4;       // usual misses; more in a short series
constexpr double kLeastScatter = 0.25; // so what misses by less than its own sd is none
constexpr std::size_t kLeastForOutliers = 5;
constexpr int kWiggles = 22; // from a line to a curve through every sample, by steps of 4
constexpr double kLeastWiggle = 1.0 / 64;
constexpr double kDailyRidge = 0.01; // as of a hundredth of a sample
constexpr int kDaysForDaily = 5;
constexpr double kApartDays = 3.0 / 24;
constexpr double kToldWithinHours = 2;
constexpr double kLeastBridgeDays = 2;
constexpr double kBridgedSpacings = 3;

struct Desk
{
    std::span<std::size_t> order; ///< measured samples by time
    std::span<Step> steps;
    std::span<std::size_t> sample_of_step; ///< kCurveStep: a place of the curve
    std::span<Smoothed> smoothed;
    std::span<double> miss; ///< [samples], in standard deviations
    std::span<double> sorted;
    SmoothingSpline spline;

    Desk(std::size_t samples, std::size_t points, Arena& arena)
        : order(arena.take<std::size_t>(samples)), steps(arena.take<Step>(samples + points)),
          sample_of_step(arena.take<std::size_t>(samples + points)), smoothed(arena.take<Smoothed>(samples + points)),
          miss(arena.take<double>(samples)), sorted(arena.take<double>(samples))
    {
        spline.lay_out(samples + points, arena);
    }
};

bool is_measured(const GrowthSample& sample)
{
    return std::isfinite(sample.measured.value) && std::isfinite(sample.day);
}

double square(double value)
{
    return value * value;
}

std::size_t points_of(const GrowthRules& rules)
{
    return static_cast<std::size_t>(std::max(rules.curve_points, 2));
}

/// One series, from samples to what is told of it.
class Fitting
{
public:
    Fitting(std::span<const GrowthSample> samples, const GrowthRules& rules, Desk& desk, GrowthFit& fit)
        : samples_(samples), rules_(rules), desk_(desk), fit_(fit)
    {
    }

    void run()
    {
        for (SampleFit& one : fit_.samples)
            one = {SampleFit::Use::kUnmeasured, {kNone, kNone}, kNone};
        fit_.daily.fill({kNone, kNone});
        put_in_order();
        if (order_.empty()) {
            fit_.curve = {};
            return;
        }
        weigh();
        make_steps();
        suspect();
        for (int round = 0; round < kRounds; ++round) {
            separate_daily();
            fit_spline();
            if (!judge())
                break;
        }
        tell_samples();
        tell_curve();
        tell_daily();
    }

private:
    const GrowthSample& sample(std::size_t i) const { return samples_[i]; }
    bool is_used(std::size_t i) const { return fit_.samples[i].use == SampleFit::Use::kUsed; }
    double time_of(double day) const { return span_days_ > 0 ? (day - first_day_) / span_days_ : 0; }
    double variance(std::size_t i) const { return sds_are_given_ ? square(std::max(sd_of(i), usual_sd_ / 10)) : 1; }

    void put_in_order()
    {
        std::size_t count = 0;
        for (std::size_t i = 0; i < samples_.size(); ++i)
            if (is_measured(samples_[i])) {
                desk_.order[count++] = i;
                fit_.samples[i].use = SampleFit::Use::kUsed;
            }
        order_ = desk_.order.first(count);
        std::ranges::sort(order_, [&](std::size_t a, std::size_t b) {
            return samples_[a].day != samples_[b].day ? samples_[a].day < samples_[b].day : a < b;
        });
        if (order_.empty())
            return;
        first_day_ = samples_[order_.front()].day;
        span_days_ = samples_[order_.back()].day - first_day_;
    }

    double sd_of(std::size_t i) const
    {
        const double sd = samples_[i].measured.sd;
        return sd > 0 && std::isfinite(sd) ? sd : usual_sd_;
    }

    void weigh()
    {
        std::size_t given = 0;
        for (const std::size_t i : order_)
            if (const double sd = samples_[i].measured.sd; sd > 0 && std::isfinite(sd))
                desk_.sorted[given++] = sd;
        sds_are_given_ = given > 0;
        if (sds_are_given_)
            usual_sd_ = median_of(desk_.sorted.first(given));
    }

    /// Samples and the curve's places, by time.
    void make_steps()
    {
        const std::size_t points = span_days_ > 0 ? points_of(rules_) : 1;
        fit_.curve = fit_.curve.first(points);
        steps_ = desk_.steps.first(order_.size() + points);
        std::size_t next = 0, point = 0;
        for (std::size_t at = 0; at < steps_.size(); ++at) {
            const double day =
                first_day_ +
                span_days_ * (points > 1 ? static_cast<double>(point) / static_cast<double>(points - 1) : 0);
            const bool is_point = point < points && (next == order_.size() || day <= samples_[order_[next]].day);
            if (is_point)
                fit_.curve[point++].day = day;
            desk_.sample_of_step[at] = is_point ? kCurveStep : order_[next++];
            steps_[at] = {.time = time_of(is_point ? day : samples_[desk_.sample_of_step[at]].day)};
        }
    }

    /// Before the first curve: lines through neighbours that a few of them cannot turn. Without it the best curve would
    /// go through several outliers at once.
    void suspect()
    {
        constexpr std::size_t kNear = 9;
        if (order_.size() < kNear)
            return;
        std::array<LinePoint, kNear> near{};
        for (std::size_t at = 0; at < order_.size(); ++at) {
            const std::size_t from = std::min(at - std::min(at, kNear / 2), order_.size() - kNear);
            for (std::size_t k = 0; k < kNear; ++k) {
                const GrowthSample& one = samples_[order_[from + k]];
                near[k] = {time_of(one.day), one.measured.value};
            }
            const std::size_t i = order_[at];
            const double line = repeated_median_line(near, time_of(samples_[i].day));
            desk_.miss[i] = (samples_[i].measured.value - line) / std::sqrt(variance(i));
        }
        (void)set_aside();
    }

    /// Whether it changed which samples are outliers.
    bool set_aside()
    {
        std::size_t count = 0;
        for (const std::size_t i : order_)
            if (std::isfinite(desk_.miss[i]))
                desk_.sorted[count++] = std::abs(desk_.miss[i]);
        if (count < kLeastForOutliers)
            return false;
        const double usual = std::max(kSdOfMedianDeviation * median_of(desk_.sorted.first(count)), kLeastScatter);
        const double limit = usual * kOutlierAt * (1 + 5 / static_cast<double>(count));
        bool changed = false;
        for (const std::size_t i : order_) {
            const auto use = std::abs(desk_.miss[i]) > limit ? SampleFit::Use::kOutlier : SampleFit::Use::kUsed;
            changed = changed || use != fit_.samples[i].use;
            fit_.samples[i].use = use;
        }
        return changed;
    }

    /// Only where days enough have samples at several times of day.
    void separate_daily()
    {
        int days = 0;
        double day = -kNone, first = 0;
        bool counted = true;
        mean_daily_ = {};
        double used = 0;
        for (const std::size_t i : order_) {
            if (!is_used(i))
                continue;
            const Daily row = daily_regressors(samples_[i].hour);
            for (std::size_t k = 0; k < kDaily; ++k)
                mean_daily_[k] += row[k];
            ++used;
            if (!(std::floor(samples_[i].day) == day)) {
                day = std::floor(samples_[i].day);
                first = samples_[i].day;
                counted = false;
            }
            if (!counted && std::isfinite(samples_[i].hour) && samples_[i].day - first >= kApartDays) {
                counted = true;
                ++days;
            }
        }
        fit_.daily_known = days >= kDaysForDaily;
        for (double& mean : mean_daily_)
            mean = fit_.daily_known ? mean / used : 0;
    }

    void fit_spline()
    {
        double noise = 0, used = 0;
        for (std::size_t at = 0; at < steps_.size(); ++at) {
            const std::size_t i = desk_.sample_of_step[at];
            Step& step = steps_[at];
            step.daily = {};
            if (i != kCurveStep) {
                step.value = samples_[i].measured.value;
                step.noise = is_used(i) ? variance(i) : 0;
                noise += step.noise;
                used += is_used(i) ? 1 : 0;
            }
            if (fit_.daily_known)
                step.daily = i == kCurveStep || !std::isfinite(samples_[i].hour) ? mean_daily_
                                                                                 : daily_regressors(samples_[i].hour);
        }
        noise /= used;
        const int columns = span_days_ == 0 || used < 2 ? 1 : fit_.daily_known ? growth::kColumns : 2;
        SmoothingSpline& spline = desk_.spline;
        double best = kNone, best_wiggle = 0;
        for (int k = 0; k < kWiggles; ++k) {
            const double wiggle =
                noise * kLeastWiggle * static_cast<double>(std::uint64_t{1} << (2U * static_cast<unsigned>(k)));
            if (spline.fit(steps_, columns, wiggle, kDailyRidge / noise, sds_are_given_) &&
                !(spline.badness() >= best)) {
                best = spline.badness();
                best_wiggle = wiggle;
            }
        }
        slope_known_ = columns > 1;
        (void)spline.fit(steps_, columns, best_wiggle, kDailyRidge / noise, sds_are_given_);
        spline.smooth(steps_, desk_.smoothed.first(steps_.size()));
    }

    /// Each sample against what the others say. Whether that changes which ones are outliers.
    bool judge()
    {
        for (std::size_t at = 0; at < steps_.size(); ++at) {
            const std::size_t i = desk_.sample_of_step[at];
            if (i == kCurveStep)
                continue;
            const double noise = variance(i) * desk_.spline.noise_factor();
            const double miss = samples_[i].measured.value - desk_.smoothed[at].level;
            const double left =
                is_used(i) ? noise - desk_.smoothed[at].level_var : noise + desk_.smoothed[at].level_var;
            desk_.miss[i] = left > 1e-6 * noise ? miss / std::sqrt(left) : kNone;
        }
        return set_aside();
    }

    void tell_samples()
    {
        for (std::size_t at = 0; at < steps_.size(); ++at)
            if (const std::size_t i = desk_.sample_of_step[at]; i != kCurveStep) {
                const Smoothed& here = desk_.smoothed[at];
                fit_.samples[i].expected = {here.level, std::sqrt(here.level_var)};
                fit_.samples[i].miss = desk_.miss[i];
                ++(is_used(i) ? fit_.used : fit_.outliers);
            }
        fit_.sd_factor = sds_are_given_ ? std::sqrt(desk_.spline.noise_factor()) : kNone;
    }

    double longest_bridge()
    {
        if (rules_.longest_bridge_days > 0)
            return rules_.longest_bridge_days;
        std::size_t count = 0;
        for (std::size_t at = 1; at < order_.size(); ++at)
            desk_.sorted[count++] = samples_[order_[at]].day - samples_[order_[at - 1]].day;
        return std::max(kLeastBridgeDays, count == 0 ? 0 : kBridgedSpacings * median_of(desk_.sorted.first(count)));
    }

    void tell_curve()
    {
        fit_.longest_bridge_days = longest_bridge();
        double before = first_day_; // the newest used sample
        std::size_t next = 0;       // the first used one that is not before the point
        std::size_t point = 0;
        for (std::size_t at = 0; at < steps_.size(); ++at) {
            if (desk_.sample_of_step[at] != kCurveStep)
                continue;
            GrowthPoint& out = fit_.curve[point++];
            while (next < order_.size() && (!is_used(order_[next]) || samples_[order_[next]].day < out.day)) {
                if (is_used(order_[next]))
                    before = samples_[order_[next]].day;
                ++next;
            }
            const double after = next < order_.size() ? samples_[order_[next]].day : first_day_ + span_days_;
            out =
                after - before > fit_.longest_bridge_days ? unknown_at(out.day) : known_at(out.day, desk_.smoothed[at]);
        }
    }

    static GrowthPoint unknown_at(double day) { return {day, {kNone, kNone}, {kNone, kNone}, {kNone, kNone}}; }

    GrowthPoint known_at(double day, const Smoothed& here) const
    {
        GrowthPoint out = unknown_at(day);
        out.value = {here.level, std::sqrt(here.level_var)};
        if (!slope_known_)
            return out;
        out.rate_per_day = {here.slope / span_days_, std::sqrt(here.slope_var) / span_days_};
        if (!(here.level > 0))
            return out;
        const double relative = here.slope / here.level;
        const double variance = here.slope_var - 2 * relative * here.both_cov + square(relative) * here.level_var;
        out.relative_rate_per_day = {relative / span_days_,
                                     std::sqrt(std::max(variance, 0.0)) / here.level / span_days_};
        return out;
    }

    void tell_daily()
    {
        if (!fit_.daily_known)
            return;
        for (std::size_t hour = 0; hour < fit_.daily.size(); ++hour) {
            const auto told = [&](std::size_t i) {
                return is_used(i) && clock_distance(samples_[i].hour, static_cast<double>(hour)) <= kToldWithinHours;
            };
            if (std::ranges::none_of(order_, told))
                continue;
            Daily row = daily_regressors(static_cast<double>(hour));
            for (std::size_t k = 0; k < kDaily; ++k)
                row[k] -= mean_daily_[k];
            fit_.daily[hour] = desk_.spline.daily_difference(row);
        }
    }

    std::span<const GrowthSample> samples_;
    const GrowthRules& rules_;
    Desk& desk_;
    GrowthFit& fit_;
    std::span<std::size_t> order_;
    std::span<Step> steps_;
    Daily mean_daily_{};
    double first_day_ = 0, span_days_ = 0;
    double usual_sd_ = 1;
    bool sds_are_given_ = false;
    bool slope_known_ = false;
};

struct Room
{
    Desk desk;
    GrowthFit fit;

    Room(std::size_t samples, const GrowthRules& rules, Arena& arena) : desk(samples, points_of(rules), arena)
    {
        fit.samples = arena.take<SampleFit>(samples);
        fit.curve = arena.take<GrowthPoint>(points_of(rules));
    }
};

} // namespace

std::size_t growth_bytes(std::size_t samples, const GrowthRules& rules)
{
    Arena measure;
    const Room room(samples, rules, measure);
    return measure.peak();
}

Result<GrowthFit> fit_growth(std::span<const GrowthSample> samples, const GrowthRules& rules, Arena& arena)
{
    Room room(samples.size(), rules, arena);
    if (arena.overrun())
        return failure(Fault::kSoftware, "a series of %zu samples needs %zu bytes", samples.size(),
                       growth_bytes(samples.size(), rules));
    Fitting(samples, rules, room.desk, room.fit).run();
    return GrowthFit{room.fit};
}

} // namespace dicot
