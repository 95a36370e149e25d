#include "dicot/camera_rig/settling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace dicot {
namespace {

constexpr std::int64_t kIntervalUs = 33'333;

/// Feeds level(k) of frame k, 30 a second, until the state is final.
template <typename Level>
SettlingFigures settle(Level level, const SettlingRules& rules = {})
{
    Settling settling(rules, 0);
    std::int64_t k = 0;
    while (settling.feed(static_cast<std::uint32_t>(std::lround(256.0 * level(static_cast<double>(k)))),
                         (k + 1) * kIntervalUs) == SettlingState::kWarming &&
           k < 1'000'000)
        ++k;
    return settling.figures();
}

TEST(CameraRigSettling, AnEvenPictureSettlesAtTheFirstFrameThatCanTell)
{
    const SettlingFigures figures = settle([](double) { return 90.0; });
    EXPECT_EQ(figures.state, SettlingState::kSettled);
    EXPECT_EQ(figures.frames, 16U + 8U - 1U);
    EXPECT_EQ(figures.elapsed_us, 23 * kIntervalUs);
    EXPECT_EQ(figures.slope_q16, 0);
    EXPECT_EQ(figures.mean_luma_q8, 90U * 256U);
}

TEST(CameraRigSettling, TheSlopeOfAStraightRiseIsTheRise)
{
    for (const int window : {4, 15, 16, 64}) {
        SettlingRules rules;
        rules.window = window;
        rules.most_frames = 80;
        EXPECT_EQ(settle([](double k) { return 20.0 + 2.5 * k; }, rules).slope_q16, 163'840) << window;
        EXPECT_EQ(settle([](double k) { return 250.0 - 0.25 * k; }, rules).slope_q16, -16'384) << window;
    }
}

TEST(CameraRigSettling, TheBoundItselfIsFlatAndOneStepAboveIsNot)
{
    SettlingRules rules;
    rules.most_slope_q8 = 64;
    EXPECT_EQ(settle([](double k) { return 20.0 + 64.0 / 256 * k; }, rules).state, SettlingState::kSettled);
    EXPECT_EQ(settle([](double k) { return 20.0 + 65.0 / 256 * k; }, rules).state, SettlingState::kGaveUp);
}

TEST(CameraRigSettling, TwentyDarkFramesAreNotTakenForAFlatPicture)
{
    const auto level = [](double k) { return k < 20 ? 0.5 : 110.0 * (1.0 - std::exp(-(k - 20) / 8.0)); };
    const SettlingFigures figures = settle(level);
    EXPECT_EQ(figures.state, SettlingState::kSettled);
    // Where the picture rises by less than 3/16 of a level a frame: 110 / 8 exp(-t / 8) = 3/16 at t = 34.4.
    EXPECT_GT(figures.frames, 20U + 34U);
    EXPECT_LT(figures.frames, 20U + 34U + 16U + 8U);
    EXPECT_NEAR(level(figures.frames), 110.0, 1.0);
}

TEST(CameraRigSettling, ADarkRoomIsGivenUpWithItsMean)
{
    const SettlingFigures figures = settle([](double) { return 1.5; });
    EXPECT_EQ(figures.state, SettlingState::kGaveUp);
    EXPECT_EQ(figures.frames, 300U);
    EXPECT_EQ(figures.mean_luma_q8, 384U);
    EXPECT_EQ(figures.slope_q16, 0);
}

TEST(CameraRigSettling, FlickerOfAGrowLightAroundASteadyMeanSettles)
{
    for (const double period : {2.0, 3.0, 5.0}) { // 100 or 120 Hz as 30 frames a second see it
        const SettlingFigures figures =
            settle([period](double k) { return 100.0 + 3.0 * std::sin(6.283185 * k / period + 0.7); });
        EXPECT_EQ(figures.state, SettlingState::kSettled) << period;
        EXPECT_LT(figures.frames, 60U) << period;
    }
}

TEST(CameraRigSettling, ASlowSwingIsNotSettledAtItsTurns)
{
    const SettlingFigures figures = settle([](double k) { return 100.0 + 20.0 * std::sin(6.283185 * k / 60.0); });
    EXPECT_EQ(figures.state, SettlingState::kGaveUp);
    EXPECT_EQ(figures.frames, 300U);
}

TEST(CameraRigSettling, TheBoundOfTimeHoldsWithAndWithoutFrames)
{
    SettlingRules rules;
    rules.most_us = 1'000'000;
    const SettlingFigures climbing = settle([](double k) { return 2.0 * k; }, rules);
    EXPECT_EQ(climbing.state, SettlingState::kGaveUp);
    EXPECT_EQ(climbing.frames, 31U); // 30 x 33,333 us is 10 us short of a second
    Settling silent(rules, 500);
    EXPECT_EQ(silent.note_time(1'000'499), SettlingState::kWarming);
    EXPECT_EQ(silent.note_time(1'000'500), SettlingState::kGaveUp);
    EXPECT_FALSE(silent.figures().window_full);
    EXPECT_EQ(silent.figures().frames, 0U);
}

TEST(CameraRigSettling, AFinalStateStays)
{
    SettlingRules rules;
    rules.most_frames = 30;
    Settling settling(rules, 0);
    for (int k = 0; k < 23; ++k)
        settling.feed(25'600, k);
    ASSERT_EQ(settling.figures().state, SettlingState::kSettled);
    EXPECT_EQ(settling.feed(0, 100'000'000), SettlingState::kSettled);
    EXPECT_EQ(settling.note_time(100'000'000), SettlingState::kSettled);
    EXPECT_EQ(settling.figures().frames, 23U);
    EXPECT_EQ(settling.figures().elapsed_us, 22);
}

TEST(CameraRigSettling, AbsurdRulesAndLumaAreHeldToTheirBounds)
{
    for (const int window : {std::numeric_limits<int>::min(), 0, std::numeric_limits<int>::max()}) {
        SettlingRules rules;
        rules.window = window;
        rules.most_frames = 100;
        rules.most_slope_q8 = std::numeric_limits<std::uint32_t>::max();
        rules.flat_in_a_row = -3;
        Settling settling(rules, 0);
        while (settling.feed(std::numeric_limits<std::uint32_t>::max(), 0) == SettlingState::kWarming) {
        }
        EXPECT_EQ(settling.figures().state, SettlingState::kSettled);
        EXPECT_EQ(settling.figures().frames, window > 0 ? 64U : 4U);
        EXPECT_EQ(settling.figures().mean_luma_q8, 65'280U);
    }
}

} // namespace
} // namespace dicot
