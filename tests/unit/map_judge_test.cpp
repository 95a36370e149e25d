#include "map_judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace dicot::app {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr Rgb8 kWhite{255, 255, 255};
constexpr Rgb8 kGrey{128, 128, 128};

TEST(JudgeMap, SixPixelsWorkedByHand)
{
    // Errors: 0, 0.75, 1.5, 5, missing, and one whose truth is unknown.
    const std::vector<float> map = {10, 10.75F, 8.5F, 15, kNone, 3};
    const std::vector<float> truth = {10, 10, 10, 10, 10, kNone};
    const MapJudgement found = judge_map({map.data(), 3, 2}, {truth.data(), 3, 2}, {});
    EXPECT_EQ(found.judged, 5);
    EXPECT_EQ(found.valued, 4);
    EXPECT_DOUBLE_EQ(found.density(), 0.8);
    EXPECT_EQ(found.bad[0], 4); // beyond 0.5: 0.75, 1.5, 5 and the missing one
    EXPECT_EQ(found.bad[1], 3);
    EXPECT_EQ(found.bad[2], 2);
    EXPECT_EQ(found.bad[3], 2);
    EXPECT_DOUBLE_EQ(found.bad_share(2), 0.4);
    EXPECT_EQ(found.wrong, (std::array<std::int64_t, 4>{3, 2, 1, 1})) << "the missing one is bad, not wrong";
    EXPECT_DOUBLE_EQ(found.wrong_share(2), 0.25);
    EXPECT_DOUBLE_EQ(found.mean_error_px, 7.25 / 4);
    EXPECT_DOUBLE_EQ(found.rms_error_px, std::sqrt((0.5625 + 2.25 + 25) / 4));
}

TEST(JudgeMap, AnErrorOfExactlyTheThresholdIsNotBad)
{
    const std::vector<float> map = {1.5F, 2, 3, 5};
    const std::vector<float> truth = {1, 1, 1, 1};
    const MapJudgement found = judge_map({map.data(), 4, 1}, {truth.data(), 4, 1}, {});
    EXPECT_EQ(found.bad, (std::array<std::int64_t, 4>{3, 2, 1, 0}));
}

TEST(JudgeMap, OnlyTheWhiteOfTheMaskCounts)
{
    const std::vector<float> map = {1, 1, 1};
    const std::vector<float> truth = {1, 9, 9};
    const std::vector<Rgb8> mask = {kWhite, kGrey, Rgb8{255, 255, 254}};
    const MapJudgement found = judge_map({map.data(), 3, 1}, {truth.data(), 3, 1}, {mask.data(), 3, 1});
    EXPECT_EQ(found.judged, 1);
    EXPECT_EQ(found.bad[3], 0);
}

TEST(JudgeMap, ALargerTruthIsTakenAtThePixelCentresAndDividedByItsMultiple)
{
    // k = 3: the centres are columns 1 and 4 of row 1. Everything else would judge wrong.
    const std::vector<float> map = {4, 5};
    std::vector<float> truth(18, 99);
    truth[6 + 1] = 12;
    truth[6 + 4] = 18;
    std::vector<Rgb8> mask(18, Rgb8{0, 0, 0});
    mask[6 + 1] = kWhite;
    mask[6 + 4] = kWhite;
    const MapJudgement found = judge_map({map.data(), 2, 1}, {truth.data(), 6, 3}, {mask.data(), 6, 3});
    EXPECT_EQ(found.judged, 2);
    EXPECT_DOUBLE_EQ(found.mean_error_px, 0.5);
    // A mask of the map's own size serves a larger truth as well.
    const std::vector<Rgb8> small = {kWhite, kGrey};
    EXPECT_EQ(judge_map({map.data(), 2, 1}, {truth.data(), 6, 3}, {small.data(), 2, 1}).judged, 1);
}

TEST(JudgeMap, AnEvenMultipleTakesTheLastPixelBeforeTheCentre)
{
    EXPECT_EQ(centre_of(0, 1), 0);
    EXPECT_EQ(centre_of(5, 2), 10);
    EXPECT_EQ(centre_of(5, 4), 21);
}

TEST(JudgeMap, SizesThatAreNoWholeMultipleAreTold)
{
    EXPECT_EQ(multiple_of(641, 555, 641, 555), 1);
    EXPECT_EQ(multiple_of(641, 555, 1282, 1110), 2);
    EXPECT_EQ(multiple_of(641, 555, 1282, 1111), 0);
    EXPECT_EQ(multiple_of(641, 555, 1283, 1110), 0);
    EXPECT_EQ(multiple_of(641, 555, 640, 554), 0);
}

} // namespace
} // namespace dicot::app
