// The residual of rows that are known to be apart: a drawn scene, its true disparities, no matcher.
#include "lent_arena.h"
#include "spotted_wall.h"

#include "dicot/drift/drift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace dicot {
namespace {

constexpr int kWidth = 480, kHeight = 360;
constexpr double kRadian = 57.29577951308232; ///< degrees

/// How the right picture differs from one whose rows are aligned.
struct Flaw
{
    double down_px = 0;
    double clockwise_deg = 0; ///< of the picture
    double larger = 0;        ///< 0.001: by a thousandth
    double noise = 0;         ///< levels, both pictures
    double contrast = 1, brighter = 0;
    double disparity_error_px = 0; ///< standard deviation, of the map
    double aside_px = 0;           ///< the right picture, and with it what the matcher finds
};

struct Colours
{
    std::vector<Rgb8> pixels;

    template <typename Level>
    Colours(const Level& level, double noise, unsigned seed)
    {
        std::mt19937 random{seed};
        std::normal_distribution<double> error(0, 1);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const double grey = level(x - (kWidth - 1) / 2.0, y - (kHeight - 1) / 2.0) + noise * error(random);
                const auto value = static_cast<std::uint8_t>(std::clamp(grey + 0.5, 0.0, 255.0));
                pixels.push_back({value, value, value});
            }
    }
    ImageView<const Rgb8> view() const { return {pixels.data(), kWidth, kHeight}; }
};

/// A wall that leans away downwards: disparities from 20 to 30 px.
class Drift : public testing::Test
{
protected:
    static double disparity(double y) { return 25 - 5 * y / (kHeight / 2.0); }

    Colours left(const Flaw& flaw) const
    {
        return {[&](double x, double y) { return scene(x, y); }, flaw.noise, 1};
    }
    Colours right(const Flaw& flaw) const
    {
        const double turn = flaw.clockwise_deg / kRadian;
        return {[&](double x, double y) {
                    // Where a right picture without the flaw has what this one has here.
                    const double u = x / (1 + flaw.larger), v = (y - flaw.down_px) / (1 + flaw.larger);
                    const double a = u * std::cos(turn) + v * std::sin(turn);
                    const double b = v * std::cos(turn) - u * std::sin(turn);
                    return flaw.contrast * scene(a + disparity(b) - flaw.aside_px, b) + flaw.brighter;
                },
                flaw.noise, 2};
    }
    static Result<EpipolarDrift> measure(const Colours& left, const Colours& right, const Flaw& flaw,
                                         std::uint8_t confidence = 200)
    {
        std::mt19937 random{7};
        std::normal_distribution<double> error(0, flaw.disparity_error_px > 0 ? flaw.disparity_error_px : 1e-9);
        std::vector<DispQ8> disparities;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                disparities.push_back(static_cast<DispQ8>(
                    256 * (disparity(y - (kHeight - 1) / 2.0) - flaw.aside_px - 10 + error(random)) + 0.5));
        const std::vector<std::uint8_t> confidences(disparities.size(), confidence);
        DisparityMap map;
        map.relative = {disparities.data(), kWidth, kHeight};
        map.confidence = {confidences.data(), kWidth, kHeight};
        map.min_disparity = 10;
        map.disparities = 32;
        test::LentArena scratch(drift_scratch_bytes(kWidth, kHeight));
        Arena& arena = scratch.arena();
        Result<EpipolarDrift> drift = measure_drift(left.view(), right.view(), map, arena);
        EXPECT_EQ(arena.used(), 0U);
        EXPECT_FALSE(arena.overrun());
        return drift;
    }
    EpipolarDrift drift_of(const Flaw& flaw) const { return measure(left(flaw), right(flaw), flaw).value(); }

    double scene(double x, double y) const { return wall_.at(x, y); }

private:
    test::SpottedWall wall_{3};
};

TEST_F(Drift, AShiftIsMeasuredToATwentiethOfAPixel)
{
    for (const double down_px : {-2.3, -1.0, -0.25, 0.0, 0.1, 0.25, 0.5, 0.75, 1.0, 2.5}) {
        const EpipolarDrift drift = drift_of({.down_px = down_px});
        ASSERT_TRUE(drift.known()) << drift.points << " of " << drift.tried;
        EXPECT_GT(drift.points, 200) << "of " << drift.tried;
        EXPECT_LE(drift.tried, EpipolarDrift::kMostPoints);
        EXPECT_NEAR(drift.median_px, down_px, 0.02) << drift.points << " points";
        EXPECT_LT(drift.spread_px, 0.05);
        EXPECT_NEAR(drift.slope_x, 0, 1e-4);
        EXPECT_NEAR(drift.slope_y, 0, 1e-4);
    }
}

TEST_F(Drift, NoiseExposureAndRoughDisparitiesMoveItLittle)
{
    const Flaw noisy{.down_px = 0.3, .noise = 3}, dim{.down_px = 0.3, .noise = 1, .contrast = 0.7, .brighter = 20},
        rough{.down_px = 0.3, .noise = 1, .disparity_error_px = 0.25};
    for (const Flaw& flaw : {noisy, dim, rough}) {
        const EpipolarDrift drift = drift_of(flaw);
        ASSERT_TRUE(drift.known());
        EXPECT_GT(drift.points, 150) << "of " << drift.tried;
        EXPECT_NEAR(drift.median_px, 0.3, 0.05);
        EXPECT_LT(drift.spread_px, 0.15);
    }
}

TEST_F(Drift, RollAndSizeAreSlopes)
{
    for (const double degrees : {-0.3, 0.05, 0.2}) {
        const EpipolarDrift drift = drift_of({.clockwise_deg = degrees, .noise = 1});
        ASSERT_TRUE(drift.known());
        EXPECT_NEAR(drift.slope_x * kRadian, degrees, 0.02) << degrees;
        EXPECT_NEAR(drift.slope_y, 0, 3e-4) << degrees;
        EXPECT_NEAR(drift.corner_px, std::fabs(degrees) / kRadian * kWidth / 2, 0.1) << degrees;
    }
    for (const double larger : {-0.004, 0.002}) {
        const EpipolarDrift drift = drift_of({.larger = larger, .noise = 1});
        ASSERT_TRUE(drift.known());
        EXPECT_NEAR(drift.slope_y, larger, 3e-4);
        EXPECT_NEAR(drift.slope_x, 0, 3e-4);
    }
}

TEST_F(Drift, ATurnAboutTheVerticalIsNotSeen)
{
    const EpipolarDrift drift = drift_of({.down_px = 0.2, .aside_px = 3.3});
    EXPECT_NEAR(drift.median_px, 0.2, 0.02);
    EXPECT_NEAR(drift.slope_x, 0, 1e-4);
}

TEST_F(Drift, TheSameFiguresComeOutEverywhere)
{
    // No sine and no noise in these pictures: + - * / alone. As g++ 12 for x86-64 had them.
    const EpipolarDrift drift = drift_of({.down_px = 0.25});
    EXPECT_EQ(drift.points, 277);
    EXPECT_EQ(drift.median_px, 0x1.06327cf1fp-2);
    EXPECT_EQ(drift.slope_x, 0x1.0ae93c0c8f54dp-19);
    EXPECT_EQ(drift.slope_y, -0x1.fa7b8070da254p-16);
}

TEST_F(Drift, WithoutTextureWithoutMatchesAndOfAnotherSceneThereIsNoVerdict)
{
    const Colours flat([](double, double) { return 120.0; }, 2, 5),
        other_flat([](double, double) { return 120.0; }, 2, 6);
    const EpipolarDrift nothing = measure(flat, other_flat, {}).value();
    EXPECT_FALSE(nothing.known()) << nothing.points << " of " << nothing.tried;
    EXPECT_EQ(nothing.median_px, 0);
    // Bars along the rows tell of y alone, bars across them of nothing: neither is taken for a place.
    const Colours bars([](double x, double) { return 128 + 100 * std::sin(x / 3); }, 0, 5);
    EXPECT_EQ(measure(bars, bars, {}).value().tried, 0);
    EXPECT_EQ(measure(left({}), right({}), {}, 0).value().tried, 0) << "no confidence";
    test::SpottedWall elsewhere{99};
    const Colours foreign([&](double x, double y) { return elsewhere.at(x, y); }, 0, 5);
    const EpipolarDrift foreign_drift = measure(left({}), foreign, {}).value();
    EXPECT_GT(foreign_drift.tried, 200);
    EXPECT_FALSE(foreign_drift.known()) << foreign_drift.points;
}

TEST_F(Drift, BeyondItsReachItIsNotInvented)
{
    const EpipolarDrift drift = drift_of({.down_px = 9});
    EXPECT_FALSE(drift.known()) << drift.points << " of " << drift.tried << ", median " << drift.median_px;
}

TEST_F(Drift, ItsMemoryFitsIntoAPictureOfThreeBytesAPixel)
{
    for (int width = 24; width < 2000; width += 1 + width / 5)
        for (int height = 24; height < 2000; height += 1 + height / 5)
            EXPECT_LE(drift_scratch_bytes(width, height), std::size_t(3 * width * height)) << width << " x " << height;
}

TEST_F(Drift, SizesThatDoNotBelongTogetherAndASmallArenaAreRefused)
{
    const Colours some = left({});
    std::vector<DispQ8> disparities(static_cast<std::size_t>(kWidth) * kHeight, kDispMissing);
    const std::vector<std::uint8_t> confidences(disparities.size(), 0);
    DisparityMap map;
    map.relative = {disparities.data(), kWidth, kHeight - 1};
    map.confidence = {confidences.data(), kWidth, kHeight - 1};
    Arena none;
    EXPECT_EQ(measure_drift(some.view(), some.view(), map, none).status().fault(), Fault::kBadData);
    map.relative.height = map.confidence.height = kHeight;
    EXPECT_EQ(measure_drift(some.view(), some.view(), map, none).status().fault(), Fault::kConfig);
}

} // namespace
} // namespace dicot
