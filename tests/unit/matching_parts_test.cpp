// The fixed-point parts of the matcher against their definitions in double precision.
#include "doubt.h"
#include "lab.h"
#include "tables.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dicot::matching {
namespace {

struct RealLab
{
    double l, a, b;
};

RealLab real_lab(Rgb8 colour)
{
    const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    const auto f = [](double t) { return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0; };
    const double r = linear(colour.r / 255.0);
    const double g = linear(colour.g / 255.0);
    const double b = linear(colour.b / 255.0);
    const double fx = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
    const double fy = f(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
    const double fz = f((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
    return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}

TEST(Lab, StaysWithinAFifthOfAUnitOfTheRealColourAndWithinTheKernelsDomain)
{
    LabTables tables;
    fill(tables);
    double worst = 0;
    for (int r = 0; r < 256; r += 5) {
        for (int g = 0; g < 256; g += 5) {
            for (int b = 0; b < 256; b += 5) {
                const Rgb8 colour{static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g),
                                  static_cast<std::uint8_t>(b)};
                const LabPixel fixed = lab_of(colour, tables);
                const RealLab real = real_lab(colour);
                worst = std::max({worst, std::abs(fixed.l / double{kLabScale} - real.l),
                                  std::abs(fixed.a / double{kLabScale} - real.a),
                                  std::abs(fixed.b / double{kLabScale} - real.b)});
                ASSERT_LE(std::abs(fixed.a), 3000);
                ASSERT_LE(std::abs(fixed.b), 3000);
            }
        }
    }
    std::printf("worst CIELAB error: %.3f units\n", worst);
    EXPECT_LT(worst, 0.2);
}

TEST(Lab, GreysHaveNoColour)
{
    LabTables tables;
    fill(tables);
    for (int v = 0; v < 256; ++v) {
        const auto g = static_cast<std::uint8_t>(v);
        const LabPixel lab = lab_of({g, g, g}, tables);
        EXPECT_LE(std::abs(lab.a), 1) << v;
        EXPECT_LE(std::abs(lab.b), 1) << v;
    }
    EXPECT_EQ(lab_of({0, 0, 0}, tables).l, 0);
    EXPECT_EQ(lab_of({255, 255, 255}, tables).l, 100 * kLabScale);
}

TEST(ColourWeights, FollowEquationSixWithinOnePercentAndAnUlp)
{
    for (const double gamma : {1.0, 6.0, 30.0}) {
        ColourWeights weights;
        weights.fill(gamma);
        for (int distance = 0; distance < 100 * kLabScale; distance += 3) {
            const PairS16 p_la{static_cast<std::int16_t>(distance), 0};
            const PairS16 q_la{0, 0};
            const PairS16 b{0, 0};
            const double real = kLeftWeightOne * std::exp(-distance / double{kLabScale} / gamma);
            const double fixed = weights.between({&p_la, &b}, 0, {&q_la, &b}, 0);
            // Half a step of the table in the distance: 1 / 256 of it.
            const double slack = real * (distance / double{kLabScale} / gamma) / 200 + 0.51;
            ASSERT_NEAR(fixed, real, slack) << "distance " << distance << "/16, gamma " << gamma;
        }
        const PairS16 outside{kLabOutside, 0};
        const PairS16 inside{1600, 0};
        const PairS16 b{0, 0};
        EXPECT_EQ(weights.between({&outside, &b}, 0, {&inside, &b}, 0), 0) << "gamma " << gamma;
    }
}

TEST(CostTables, FollowEquationsTenToTwelve)
{
    CostTables tables;
    fill_costs(tables, MatchCost::kAdCensus);
    for (int sum = 0; sum <= 765; ++sum)
        EXPECT_NEAR(tables.difference[sum], kCostMax / 2.0 * (1 - std::exp(-sum / 3.0 / 15)), 0.5001) << sum;
    for (int bits = 0; bits <= 8; ++bits)
        EXPECT_NEAR(tables.census[bits], kCostMax / 2.0 * (1 - std::exp(-bits / 5.0)), 0.5001) << bits;
    EXPECT_LE(tables.difference[765] + tables.census[8], kCostMax);
    fill_costs(tables, MatchCost::kTad);
    EXPECT_EQ(tables.difference[0], 0);
    EXPECT_EQ(tables.difference[765], kCostMax);
    EXPECT_EQ(tables.census[8], 0);
}

TEST(Doubt, GoesByTheLogarithm)
{
    EXPECT_EQ(log2_q8(0), 0);
    for (std::uint64_t x = 1; x < 1u << 20; x += 1 + x / 7)
        EXPECT_NEAR(log2_q8(x) / 256.0, std::log2(static_cast<double>(x)), 0.09) << x; // a chord is 0.086 below
}

TEST(Doubt, GrowsWithWhatSpeaksAgainst)
{
    constexpr std::int64_t kVariance = 9 * 256, kTexture = 400, kSupport = 30 * 127;
    const int shift = doubt_of_shift(kVariance, kTexture, kSupport);
    EXPECT_GT(doubt_of_shift(4 * kVariance, kTexture, kSupport), shift);
    EXPECT_GT(doubt_of_shift(kVariance, kTexture / 4, kSupport), shift);
    EXPECT_GT(doubt_of_shift(kVariance, kTexture, 2 * kSupport), shift);
    EXPECT_GT(doubt_of_plane(40, 100, 0), doubt_of_plane(90, 100, 0));
    EXPECT_GT(doubt_of_plane(90, 100, 1024), doubt_of_plane(90, 100, 0));
    EXPECT_GT(doubt_of_winner(512, 50), doubt_of_winner(0, 50));
    EXPECT_GT(doubt_of_winner(0, 5), doubt_of_winner(0, 50));
}

TEST(Confidence, FallsWithDoubtAndWithDistance)
{
    constexpr int kSure = -2500, kTop = 160;
    EXPECT_LT(confidence_of(kSure + 256, 100, kTop), confidence_of(kSure, 100, kTop));
    EXPECT_EQ(confidence_of(kSure, 50, kTop), confidence_of(kSure + 3 * 256, 100, kTop)); // twice as far
    EXPECT_EQ(confidence_of(kSure, 50, kTop), confidence_of(kSure, 100, 2 * kTop));
    EXPECT_EQ(confidence_of(-14 * 256, kTop, kTop), 255);
    EXPECT_EQ(confidence_of(kHopeless, 0, kTop), 1);
}

} // namespace
} // namespace dicot::matching
