#include "dicot/camera_rig/ladder.h"
#include "dicot/replay/replay_camera.h"
#include "picture_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace dicot {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<Shake> all_steps(Ladder& ladder, std::int64_t step_us = 1)
{
    std::vector<Shake> steps;
    std::int64_t now_us = 0;
    while (const std::optional<Shake> step = ladder.failed("no frame", now_us)) {
        steps.push_back(*step);
        now_us += step_us;
    }
    return steps;
}

TEST(CameraRigLadder, StepsBecomeHarderAndEnd)
{
    Ladder ladder({.tries = {2, 1, 1}});
    EXPECT_THAT(all_steps(ladder), ElementsAre(Shake::kRestart, Shake::kRestart, Shake::kReopen, Shake::kPort));
    EXPECT_TRUE(ladder.figures().gave_up);
    EXPECT_EQ(ladder.figures().recoveries, 0U);
    EXPECT_EQ(ladder.failed("again", 0), std::nullopt);
}

TEST(CameraRigLadder, AStepWithoutTriesIsLeftOut)
{
    Ladder ladder({.tries = {0, 1, 0}});
    EXPECT_THAT(all_steps(ladder), ElementsAre(Shake::kReopen));
    Ladder none({.tries = {0, 0, 0}});
    EXPECT_THAT(all_steps(none), ElementsAre());
}

TEST(CameraRigLadder, NoStepIsBegunAfterTheTime)
{
    Ladder ladder({.tries = {200, 1, 1}, .most_shakes = 200, .most_us = 1000});
    EXPECT_EQ(all_steps(ladder, 300).size(), 4U); // at 0, 300, 600, 900
}

TEST(CameraRigLadder, SuccessBeginsAnewAtTheMildestStepWithWholeTime)
{
    Ladder ladder({.tries = {1, 1, 1}, .most_us = 1000});
    EXPECT_EQ(ladder.failed("torn", 0), Shake::kRestart);
    EXPECT_EQ(ladder.failed("silent", 900), Shake::kReopen);
    ladder.delivered();
    EXPECT_EQ(ladder.figures().recoveries, 1U);
    EXPECT_STREQ(ladder.figures().first_reason.text, "torn");
    EXPECT_STREQ(ladder.figures().last_reason.text, "silent");
    EXPECT_EQ(ladder.failed("unplugged", 5000), Shake::kRestart);
    EXPECT_STREQ(ladder.figures().first_reason.text, "unplugged");
    EXPECT_EQ(ladder.failed("unplugged", 5999), Shake::kReopen);
    EXPECT_EQ(ladder.failed("unplugged", 6000), std::nullopt);
}

TEST(CameraRigLadder, ACameraThatFailsAfterEverySuccessIsGivenUp)
{
    Ladder ladder({.most_shakes = 5});
    int steps = 0;
    while (steps < 100 && ladder.failed("no frame", 0)) {
        ladder.delivered();
        ++steps;
    }
    EXPECT_EQ(steps, 5);
    EXPECT_EQ(ladder.figures().recoveries, 5U);
    EXPECT_EQ(ladder.figures().shakes[0], 5U);
}

TEST(CameraRigLadder, DeliveringWithoutAFailureIsNoRecoveryAndEndsNoVerdict)
{
    Ladder ladder({.tries = {0, 0, 0}});
    ladder.delivered();
    EXPECT_EQ(ladder.figures().recoveries, 0U);
    EXPECT_TRUE(ladder.verdict("1-1").ok());
    EXPECT_EQ(ladder.failed("no\x1b[2J frame", 0), std::nullopt);
    ladder.delivered();
    EXPECT_EQ(ladder.verdict("1-1").fault(), Fault::kUnavailable);
    EXPECT_STREQ(ladder.verdict("1-1").message(),
                 "camera 1-1: given up after 0 restarts, 0 reopens and 0 port resets; at first: no?[2J frame; at last: "
                 "no?[2J frame");
}

/// A camera of recorded pictures that misbehaves as `script` says, climbed in a time that it owns.
class CameraRigClimb : public testing::Test
{
protected:
    void open(const char* script)
    {
        test::Bytes file = test::text_bytes("P6 4 2 255\n");
        test::append(file, test::Bytes(24, 90));
        path_ = folder_.write("left.ppm", file);
        files_[0] = path_.c_str();
        const Result<ReplayScript> parsed = parse_replay_script(script, "test");
        ASSERT_TRUE(parsed.ok()) << parsed.status().message();
        ASSERT_TRUE(camera_.open(files_, {.script = parsed.value(), .virtual_now_us = &now_us_}).ok());
        ASSERT_TRUE(camera_.start(camera_.modes()[0]).ok());
    }
    Status whole_frame() { return wait_for_whole_frame(camera_, now_us_ + 500'000, 10); }
    Status climb_now(const Status& why)
    {
        return climb(
            ladder_, camera_, why, [this](Camera&) { return whole_frame(); }, [this] { return now_us_; });
    }

    const test::TempFolder folder_;
    std::string path_;
    std::vector<const char*> files_{nullptr};
    std::int64_t now_us_ = 0;
    ReplayCamera camera_;
    Ladder ladder_{LadderRules{}};
};

TEST_F(CameraRigClimb, TheMildestShakeThatHelpsEndsIt)
{
    struct Case
    {
        const char* script;
        std::array<std::uint32_t, kShakeCount> shakes;
    };
    for (const Case& one :
         {Case{"hang 1 restart", {1, 0, 0}}, Case{"hang 1 reopen", {2, 1, 0}}, Case{"hang 1 port", {2, 2, 1}},
          Case{"gone 1 reopen", {2, 1, 0}}, Case{"gone 1 port", {2, 2, 1}}}) {
        open(one.script);
        ladder_ = Ladder{LadderRules{}};
        ASSERT_TRUE(whole_frame().ok()) << one.script;
        const Status why = whole_frame();
        ASSERT_FALSE(why.ok()) << one.script;
        const Status climbed = climb_now(why);
        EXPECT_TRUE(climbed.ok()) << one.script << ": " << climbed.message();
        EXPECT_EQ(ladder_.figures().shakes, one.shakes) << one.script;
        EXPECT_EQ(ladder_.figures().recoveries, 1U) << one.script;
        EXPECT_TRUE(whole_frame().ok()) << one.script;
    }
}

TEST_F(CameraRigClimb, WhatNothingHelpsIsAMissWithItsReason)
{
    for (const char* script : {"hang 0", "gone 0"}) {
        open(script);
        ladder_ = Ladder{LadderRules{}};
        const std::int64_t begin_us = now_us_;
        const Status status = climb_now(whole_frame());
        EXPECT_EQ(status.fault(), Fault::kUnavailable);
        EXPECT_THAT(status.message(), HasSubstr("given up after 2 restarts, 2 reopens and 1 port resets; at first: "));
        EXPECT_GT(std::string(ladder_.figures().last_reason.text).size(), 10U);
        EXPECT_LE(now_us_ - begin_us, 6 * 500'000);
    }
}

TEST_F(CameraRigClimb, TornFramesAloneAreAFailureThatSaysSo)
{
    open("torn 0; torn 1; torn 2");
    const Status two = wait_for_whole_frame(camera_, now_us_ + 500'000, 2);
    EXPECT_EQ(two.fault(), Fault::kTryAgain);
    EXPECT_THAT(two.message(), HasSubstr("no whole frame among 2, the last is torn ("));
    EXPECT_TRUE(whole_frame().ok());
    EXPECT_EQ(wait_for_whole_frame(camera_, now_us_ + 500'000, 0).fault(), Fault::kTryAgain);
}

} // namespace
} // namespace dicot
