// The residual of real pairs, with the matcher's own disparities, after the right picture was moved by a known amount.
#include "lent_arena.h"
#include "matched.h"
#include "scenes.h"

#include "dicot/drift/drift.h"
#include "dicot/os/clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

namespace dicot {
namespace {

using scenes::Picture;

/// Cubic interpolation (Keys 1981), which keeps what a linear one would blur.
double keys(double t)
{
    t = std::fabs(t);
    return t < 1 ? (1.5 * t - 2.5) * t * t + 1 : t < 2 ? ((-0.5 * t + 2.5) * t - 4) * t + 2 : 0;
}

template <typename Where>
Picture moved(const Picture& from, const Where& where)
{
    Picture to = from;
    for (int y = 0; y < from.height; ++y)
        for (int x = 0; x < from.width; ++x) {
            const auto [u, v] = where(double(x), double(y));
            const int left = int(std::floor(u)), top = int(std::floor(v));
            double sum[3] = {};
            for (int j = -1; j <= 2; ++j)
                for (int i = -1; i <= 2; ++i) {
                    const double weight = keys(u - left - i) * keys(v - top - j);
                    const Rgb8 pixel = from.view().at(std::clamp(left + i, 0, from.width - 1),
                                                      std::clamp(top + j, 0, from.height - 1));
                    sum[0] += weight * pixel.r;
                    sum[1] += weight * pixel.g;
                    sum[2] += weight * pixel.b;
                }
            const auto level = [&](int k) { return std::uint8_t(std::clamp(sum[k] + 0.5, 0.0, 255.0)); };
            to.view().at(x, y) = {level(0), level(1), level(2)};
        }
    return to;
}

Picture lowered(const Picture& from, double px)
{
    return moved(from, [px](double x, double y) { return std::pair{x, y - px}; });
}

/// Turned clockwise about its middle.
Picture turned(const Picture& from, double degrees)
{
    const double turn = degrees * M_PI / 180;
    const double cx = (from.width - 1) / 2.0, cy = (from.height - 1) / 2.0;
    return moved(from, [=](double x, double y) {
        const double u = x - cx, v = y - cy;
        return std::pair{cx + u * std::cos(turn) + v * std::sin(turn), cy + v * std::cos(turn) - u * std::sin(turn)};
    });
}

struct Measured
{
    EpipolarDrift drift;
    double ms = 0;
};

Measured measure(const Picture& left, const Picture& right, int disparities)
{
    MatchOptions options;
    options.disparities = disparities;
    options.window = 15;
    const Matched matched(left.view(), right.view(), options);
    test::LentArena scratch(drift_scratch_bytes(left.width, left.height));
    const std::int64_t began_us = process_cpu_us();
    const EpipolarDrift drift = measure_drift(left.view(), right.view(), matched.map(), scratch.arena()).value();
    return {drift, double(process_cpu_us() - began_us) * 1e-3};
}

Measured told(const char* what, double truth, const Measured& measured)
{
    const EpipolarDrift& drift = measured.drift;
    std::printf("%-28s truth %6.3f | median %7.3f px, spread %.3f, roll %7.4f deg, larger %8.5f | %3d of %3d points | "
                "%.1f ms\n",
                what, truth, drift.median_px, drift.spread_px, drift.slope_x * 180 / M_PI, drift.slope_y, drift.points,
                drift.tried, measured.ms);
    return measured;
}

/// What the header promises.
double tolerance(const EpipolarDrift& drift)
{
    return drift.points >= 100 ? 0.05 : 0.1;
}

TEST(DriftOfRealPairs, AShiftAndARollAreMeasuredBesideWhatThePairHasAnyway)
{
    if (!scenes::data_present("DriftOfRealPairs.AShiftAndARollAreMeasuredBesideWhatThePairHasAnyway"))
        return;
    std::vector<scenes::Scene> all = scenes::middlebury_v2();
    all.push_back(scenes::aloe_third());
    for (const scenes::Scene& scene : all) {
        if (scene.name == "tsukuba" || scene.name == "venus")
            continue;
        const EpipolarDrift own =
            told(scene.name.c_str(), 0, measure(scene.left, scene.right, scene.disparities)).drift;
        ASSERT_TRUE(own.known());
        EXPECT_NEAR(own.median_px, 0, 0.1) << "these pairs are rectified well";
        for (const double px : {-0.5, 0.1, 0.25, 1.0}) {
            const EpipolarDrift drift =
                told("  lowered", px, measure(scene.left, lowered(scene.right, px), scene.disparities)).drift;
            ASSERT_TRUE(drift.known());
            EXPECT_NEAR(drift.median_px - own.median_px, px, tolerance(drift)) << scene.name;
        }
        const double degrees = 0.2;
        const EpipolarDrift rolled =
            told("  turned", degrees, measure(scene.left, turned(scene.right, degrees), scene.disparities)).drift;
        EXPECT_NEAR((rolled.slope_x - own.slope_x) * 180 / M_PI, degrees, 0.03) << scene.name;
    }
}

/// Means of 3 x 3 pixels, beginning `rows` rows lower: a shift by thirds of a pixel to which no interpolation adds.
Picture third_of(const Picture& full, int rows)
{
    Picture small{full.width / 3, (full.height - 3) / 3, {}};
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) {
            int sum[3] = {};
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i) {
                    const Rgb8 pixel = full.view().at(3 * x + i, 3 * y + j + rows);
                    sum[0] += pixel.r;
                    sum[1] += pixel.g;
                    sum[2] += pixel.b;
                }
            const auto mean = [&](int k) { return std::uint8_t((sum[k] + 4) / 9); };
            small.pixels.push_back({mean(0), mean(1), mean(2)});
        }
    return small;
}

TEST(DriftOfRealPairs, ThirdsOfAPixelAreMeasuredWithoutInterpolation)
{
    const std::string folder = std::string(DICOT_DATA_DIR) + "/plants/aloe-full/";
    if (!std::filesystem::exists(folder + "aloeL.jpg")) {
        std::printf("NOT RUN: DriftOfRealPairs.ThirdsOfAPixelAreMeasuredWithoutInterpolation: %s is not there\n",
                    folder.c_str());
        return;
    }
    const Picture full_left = scenes::read(folder + "aloeL.jpg"), full_right = scenes::read(folder + "aloeR.jpg");
    const Picture left = third_of(full_left, 0);
    double own = 0;
    for (int rows = 0; rows <= 3; ++rows) {
        const EpipolarDrift drift =
            told("aloe, raised", rows / 3.0, measure(left, third_of(full_right, rows), 96)).drift;
        ASSERT_TRUE(drift.known());
        if (rows == 0)
            own = drift.median_px;
        EXPECT_NEAR(drift.median_px - own, -rows / 3.0, tolerance(drift));
    }
}

} // namespace
} // namespace dicot
