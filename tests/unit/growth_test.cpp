// Series whose growth, time of day, outliers and gaps are known, because they were drawn.
#include "dicot/plant/growth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace dicot {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A fit together with its memory.
struct Fitted
{
    std::vector<std::byte> block;
    GrowthFit fit;

    explicit Fitted(const std::vector<GrowthSample>& samples, const GrowthRules& rules = {})
        : block(growth_bytes(samples.size(), rules) + Arena::kAlignment)
    {
        void* begin = block.data();
        std::size_t room = block.size();
        std::align(Arena::kAlignment, 1, begin, room);
        Arena arena{std::span{static_cast<std::byte*>(begin), growth_bytes(samples.size(), rules)}};
        Result<GrowthFit> result = fit_growth(samples, rules, arena);
        EXPECT_TRUE(result.ok()) << result.status().message();
        if (result.ok())
            fit = result.value();
    }
};

/// Leaf area in cm2 of a plant that doubles in 6 days at first and is full-grown at 400.
double area_at(double day)
{
    return 400 / (1 + 19 * std::exp(-0.1155 * day));
}

double rate_at(double day)
{
    return 0.1155 * area_at(day) * (1 - area_at(day) / 400);
}

/// Leaves that droop at noon: less of them is seen.
double droop_at(double hour)
{
    return 6 * std::cos(2 * std::numbers::pi * (hour - 2) / 24);
}

struct Season
{
    double days = 50;
    double every_hours = 2;
    double from_hour = 6, to_hour = 20; ///< samples between them
    double noise = 4;
    double swing = 1;
    unsigned seed = 1;
};

std::vector<GrowthSample> drawn(const Season& season)
{
    std::mt19937 dice(season.seed);
    std::normal_distribution<double> noise(0, season.noise);
    std::vector<GrowthSample> samples;
    for (int day = 0; day < static_cast<int>(season.days); ++day)
        for (double hour = season.from_hour; hour <= season.to_hour; hour += season.every_hours) {
            const double at = day + hour / 24;
            samples.push_back({at, hour, {area_at(at) + season.swing * droop_at(hour) + noise(dice), season.noise}});
        }
    return samples;
}

/// What the drawn swing adds on the mean of the hours of a season: it belongs to the curve.
double mean_swing(const std::vector<GrowthSample>& samples, double swing)
{
    double sum = 0;
    for (const GrowthSample& sample : samples)
        sum += swing * droop_at(sample.hour);
    return sum / static_cast<double>(samples.size());
}

struct Against
{
    double rms = 0;
    double within_two_sd = 0; ///< share
    int points = 0;
};

Against against(const GrowthFit& fit, Measured GrowthPoint::*what, const std::function<double(double)>& truth)
{
    Against result;
    int within = 0;
    for (const GrowthPoint& point : fit.curve) {
        const Measured& measured = point.*what;
        if (std::isnan(measured.value))
            continue;
        const double miss = measured.value - truth(point.day);
        result.rms += miss * miss;
        within += std::abs(miss) <= 2 * measured.sd ? 1 : 0;
        ++result.points;
    }
    result.rms = std::sqrt(result.rms / result.points);
    result.within_two_sd = static_cast<double>(within) / result.points;
    return result;
}

TEST(Growth, FindsTheCurveUnderNoiseAndItsBandHoldsIt)
{
    Season season;
    season.swing = 0;
    const Fitted fitted(drawn(season));
    const Against value = against(fitted.fit, &GrowthPoint::value, area_at);
    std::printf("curve: rms %.2f of noise 4, %.0f %% within two sd\n", value.rms, 100 * value.within_two_sd);
    EXPECT_LT(value.rms, 0.25 * season.noise);
    EXPECT_GE(value.within_two_sd, 0.85);
    const Against rate = against(fitted.fit, &GrowthPoint::rate_per_day, rate_at);
    std::printf("rate: rms %.2f of 11.5 at most, %.0f %% within two sd\n", rate.rms, 100 * rate.within_two_sd);
    EXPECT_LT(rate.rms, 0.06 * rate_at(25.5));
    EXPECT_GE(rate.within_two_sd, 0.85);
    EXPECT_NEAR(fitted.fit.sd_factor, 1, 0.1);
    EXPECT_LE(fitted.fit.outliers, 2);
}

TEST(Growth, OneStandardDeviationHoldsTwoThirdsAtLeast)
{
    double value_in = 0, rate_in = 0, all = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        Season season{.days = 30, .every_hours = 4, .seed = seed};
        const std::vector<GrowthSample> samples = drawn(season);
        const double mean = mean_swing(samples, 1);
        const Fitted fitted(samples);
        for (const GrowthPoint& point : fitted.fit.curve) {
            value_in += std::abs(point.value.value - area_at(point.day) - mean) <= point.value.sd ? 1 : 0;
            rate_in += std::abs(point.rate_per_day.value - rate_at(point.day)) <= point.rate_per_day.sd ? 1 : 0;
            ++all;
        }
    }
    std::printf("within one sd: %.0f %% of values, %.0f %% of rates\n", 100 * value_in / all, 100 * rate_in / all);
    EXPECT_GE(value_in / all, 0.60);
    EXPECT_LE(value_in / all, 0.85);
    EXPECT_GE(rate_in / all, 0.60); // more: this growth is smoother than what the spline expects
}

TEST(Growth, TellsRelativeRates)
{
    Season season;
    season.swing = 0;
    season.noise = 1;
    const Fitted fitted(drawn(season));
    const Against rate = against(fitted.fit, &GrowthPoint::relative_rate_per_day,
                                 [](double day) { return rate_at(day) / area_at(day); });
    EXPECT_LT(rate.rms, 0.05 * 0.1155);
    EXPECT_GE(rate.within_two_sd, 0.8);
}

TEST(Growth, TellsTimeOfDayFromGrowth)
{
    const Season season;
    const std::vector<GrowthSample> samples = drawn(season);
    const Fitted fitted(samples);
    ASSERT_TRUE(fitted.fit.daily_known);
    const double mean = mean_swing(samples, 1);
    const Against value = against(fitted.fit, &GrowthPoint::value, [mean](double day) { return area_at(day) + mean; });
    std::printf("curve: rms %.2f of noise 4 and swing 6, %.0f %% within two sd\n", value.rms,
                100 * value.within_two_sd);
    EXPECT_LT(value.rms, 0.25 * season.noise);
    for (int hour = 6; hour <= 20; ++hour)
        EXPECT_NEAR(fitted.fit.daily[static_cast<std::size_t>(hour)].value, droop_at(hour) - mean, 1.2) << hour;
    EXPECT_TRUE(std::isnan(fitted.fit.daily[0].value)) << "nothing was seen at night";
    EXPECT_FALSE(std::isnan(fitted.fit.daily[4].value));
}

TEST(Growth, OneSampleADayHasNoTimeOfDay)
{
    Season season;
    season.from_hour = season.to_hour = 12;
    const Fitted fitted(drawn(season));
    EXPECT_FALSE(fitted.fit.daily_known);
    EXPECT_TRUE(std::isnan(fitted.fit.daily[12].value));
}

TEST(Growth, NamesOutliersAndIsNotTurnedByThem)
{
    std::vector<GrowthSample> samples = drawn({});
    const double mean = mean_swing(samples, 1);
    std::vector<std::size_t> wild;
    for (std::size_t i = 5; i < samples.size(); i += 23) {
        wild.push_back(i);
        samples[i].measured.value += i % 2 == 0 ? 60 : -45;
    }
    wild.push_back(200); // three in a row, as of a hand in front of the camera
    wild.push_back(201);
    wild.push_back(202);
    for (std::size_t i = 200; i < 203; ++i)
        samples[i].measured.value = 20;
    const Fitted fitted(samples);
    for (const std::size_t i : wild)
        EXPECT_EQ(fitted.fit.samples[i].use, SampleFit::Use::kOutlier) << i;
    EXPECT_LE(fitted.fit.outliers, static_cast<int>(wild.size()) + 2);
    const Against value = against(fitted.fit, &GrowthPoint::value, [mean](double day) { return area_at(day) + mean; });
    std::printf("curve: rms %.2f of noise 4 with %zu outliers\n", value.rms, wild.size());
    EXPECT_LT(value.rms, 0.3 * 4);
}

TEST(Growth, AHarvestIsFollowedAndNotTakenForOutliers)
{
    constexpr double kCut = 30, kLeft = 0.5;
    std::vector<GrowthSample> samples = drawn({.swing = 0});
    for (GrowthSample& sample : samples)
        if (sample.day > kCut)
            sample.measured.value *= kLeft;
    const Fitted fitted(samples);
    EXPECT_LE(fitted.fit.outliers, 12) << "those of a day and a half";
    for (const GrowthPoint& point : fitted.fit.curve)
        if (std::abs(point.day - kCut) > 1.5) {
            EXPECT_NEAR(point.value.value, area_at(point.day) * (point.day > kCut ? kLeft : 1), 8) << point.day;
        }
}

TEST(Growth, DoesNotBridgeALongGap)
{
    std::vector<GrowthSample> samples = drawn({});
    std::erase_if(samples, [](const GrowthSample& s) { return s.day > 20 && s.day < 29; });
    std::erase_if(samples, [](const GrowthSample& s) { return s.day > 40 && s.day < 41; });
    const Fitted fitted(samples);
    EXPECT_EQ(fitted.fit.longest_bridge_days, 2);
    int open = 0;
    for (const GrowthPoint& point : fitted.fit.curve) {
        const bool inside = point.day > 19 + 20.0 / 24 && point.day < 29 + 6.0 / 24; // last sample, next sample
        EXPECT_EQ(std::isnan(point.value.value), inside) << point.day;
        open += inside ? 1 : 0;
    }
    EXPECT_GT(open, 20);
    const Fitted bridged(samples, {.longest_bridge_days = 15, .curve_points = 101});
    double widest = 0, usual = 0;
    for (const GrowthPoint& point : bridged.fit.curve) {
        EXPECT_FALSE(std::isnan(point.value.value));
        EXPECT_NEAR(point.value.value, area_at(point.day), 6 * point.value.sd + 3) << point.day;
        (point.day > 22 && point.day < 27 ? widest : usual) =
            std::max(point.day > 22 && point.day < 27 ? widest : usual, point.value.sd);
    }
    EXPECT_GT(widest, usual) << "who knows less says so";
}

TEST(Growth, OrderAndDuplicatesDoNotMatter)
{
    std::vector<GrowthSample> samples = drawn({.days = 20});
    const Fitted sorted(samples);
    std::vector<GrowthSample> mixed = samples;
    std::shuffle(mixed.begin(), mixed.end(), std::mt19937(3));
    const Fitted shuffled(mixed);
    ASSERT_EQ(sorted.fit.curve.size(), shuffled.fit.curve.size());
    for (std::size_t i = 0; i < sorted.fit.curve.size(); ++i)
        EXPECT_EQ(sorted.fit.curve[i].value.value, shuffled.fit.curve[i].value.value) << i;
    for (std::size_t i = 0; i < mixed.size(); ++i) {
        const auto at =
            static_cast<std::size_t>(std::ranges::find(samples, mixed[i].day, &GrowthSample::day) - samples.begin());
        EXPECT_EQ(shuffled.fit.samples[i].expected.value, sorted.fit.samples[at].expected.value);
    }
    std::vector<GrowthSample> twice = samples;
    twice.insert(twice.end(), samples.begin(), samples.end());
    const Fitted doubled(twice);
    EXPECT_EQ(doubled.fit.used + doubled.fit.outliers, static_cast<int>(twice.size()));
    for (std::size_t i = 0; i < sorted.fit.curve.size(); ++i)
        EXPECT_NEAR(doubled.fit.curve[i].value.value, sorted.fit.curve[i].value.value, 4) << i;
}

TEST(Growth, AFewSamplesSayAFewThings)
{
    const Fitted none(std::vector<GrowthSample>{});
    EXPECT_TRUE(none.fit.curve.empty());

    const Fitted one(std::vector<GrowthSample>{{7, 12, {50, 3}}});
    ASSERT_EQ(one.fit.curve.size(), 1U);
    EXPECT_EQ(one.fit.curve[0].day, 7);
    EXPECT_NEAR(one.fit.curve[0].value.value, 50, 1e-9);
    EXPECT_NEAR(one.fit.curve[0].value.sd, 3, 1e-9);
    EXPECT_TRUE(std::isnan(one.fit.curve[0].rate_per_day.value));
    EXPECT_EQ(one.fit.samples[0].use, SampleFit::Use::kUsed);

    const Fitted together(std::vector<GrowthSample>{{7, 12, {50, 3}}, {7, 12, {56, 3}}});
    ASSERT_EQ(together.fit.curve.size(), 1U);
    EXPECT_NEAR(together.fit.curve[0].value.value, 53, 1e-9);

    const Fitted two(std::vector<GrowthSample>{{7, 12, {50, 3}}, {8, 12, {60, 3}}});
    EXPECT_NEAR(two.fit.curve.front().value.value, 50, 1e-6);
    EXPECT_NEAR(two.fit.curve.back().value.value, 60, 1e-6);
    EXPECT_NEAR(two.fit.curve.front().rate_per_day.value, 10, 1e-6);
    EXPECT_NEAR(two.fit.curve.front().value.sd, 3, 1e-6);

    const Fitted unsaid(std::vector<GrowthSample>{{7, 12, {50, kNan}}});
    EXPECT_NEAR(unsaid.fit.curve[0].value.value, 50, 1e-9);
    EXPECT_TRUE(std::isnan(unsaid.fit.curve[0].value.sd)) << "nobody said how good it is";
}

TEST(Growth, WhatWasNotMeasuredIsPassedOver)
{
    const std::vector<GrowthSample> nothing(20, GrowthSample{1, 12, {kNan, kNan}});
    const Fitted none(nothing);
    EXPECT_TRUE(none.fit.curve.empty());
    EXPECT_EQ(none.fit.used, 0);
    EXPECT_EQ(none.fit.samples[3].use, SampleFit::Use::kUnmeasured);

    std::vector<GrowthSample> samples = drawn({.days = 20});
    const Fitted whole(samples);
    samples.insert(samples.begin() + 30, {3.1, 9, {kNan, 2}});
    const Fitted holed(samples);
    EXPECT_EQ(holed.fit.samples[30].use, SampleFit::Use::kUnmeasured);
    for (std::size_t i = 0; i < whole.fit.curve.size(); ++i)
        EXPECT_EQ(holed.fit.curve[i].value.value, whole.fit.curve[i].value.value) << i;
}

TEST(Growth, AConstantIsALineWithoutOutliers)
{
    std::vector<GrowthSample> samples;
    for (int i = 0; i < 30; ++i)
        samples.push_back({i * 1.0, 12, {80, 1}});
    const Fitted still(samples);
    EXPECT_EQ(still.fit.outliers, 0);
    for (const GrowthPoint& point : still.fit.curve) {
        EXPECT_NEAR(point.value.value, 80, 1e-6);
        EXPECT_NEAR(point.rate_per_day.value, 0, 1e-6);
    }
    samples[11].measured.value = 90;
    const Fitted jumped(samples);
    EXPECT_EQ(jumped.fit.outliers, 1);
    EXPECT_EQ(jumped.fit.samples[11].use, SampleFit::Use::kOutlier);
}

TEST(Growth, WhatScattersMoreThanItSaysGetsAWiderBand)
{
    std::vector<GrowthSample> samples = drawn({.swing = 0});
    for (GrowthSample& sample : samples)
        sample.measured.sd = 1; // it is 4
    const Fitted fitted(samples);
    EXPECT_NEAR(fitted.fit.sd_factor, 4, 0.4);
    const Against value = against(fitted.fit, &GrowthPoint::value, area_at);
    EXPECT_GE(value.within_two_sd, 0.85);
    for (GrowthSample& sample : samples)
        sample.measured.sd = kNan;
    const Fitted unsaid(samples);
    for (std::size_t i = 0; i < fitted.fit.curve.size(); ++i)
        EXPECT_NEAR(unsaid.fit.curve[i].value.sd, fitted.fit.curve[i].value.sd, 1e-6) << i;
}

TEST(Growth, AnArenaThatIsTooSmallIsRefused)
{
    const std::vector<GrowthSample> samples = drawn({.days = 3});
    alignas(Arena::kAlignment) std::array<std::byte, 1024> block{};
    Arena arena{block};
    EXPECT_EQ(fit_growth(samples, {}, arena).status().fault(), Fault::kSoftware);
}

} // namespace
} // namespace dicot
