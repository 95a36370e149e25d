#include "dicot/camera_rig/burst.h"
#include "dicot/camera_rig/stereo_camera.h"
#include "dicot/os/heap_gate.h"
#include "dicot/os/memory_block.h"
#include "dicot/replay/replay_camera.h"
#include "temp_folder.h"

#include "dicot/picture/write_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

namespace dicot {
namespace {

using test::TempFolder;
using testing::HasSubstr;
using testing::StartsWith;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// Two replay cameras on one virtual clock. Frame k shows file k modulo 2, of grey levels 100 and 104.
class Rig final : public ModePlanner
{
public:
    Rig(const char* left_script, const char* right_script, StereoRules rules = {})
    {
        for (std::size_t k = 0; k < 2; ++k) {
            std::vector<Rgb8> pixels(std::size_t{kWidth} * kHeight);
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const auto level = static_cast<std::uint8_t>(100 + 4 * k + i % 7);
                pixels[i] = {level, level, level};
            }
            paths_[k] = folder_.path("f" + std::to_string(k) + ".png");
            EXPECT_TRUE(write_png(paths_[k].c_str(), ImageView<const Rgb8>{pixels.data(), kWidth, kHeight}).ok());
            files_[k] = paths_[k].c_str();
        }
        open(left_, "replay/left", left_script);
        open(right_, "replay/right", right_script);
        rules.virtual_now_us = &now_us_;
        rules_ = rules;
    }

    BandwidthPlan plan(int refused) override
    {
        ++plans;
        const std::array offers{StreamOffer{left_.modes().front(), 0}};
        BandwidthPlan made;
        made.together = refused < at_once     ? Together::kAtOnce
                        : refused < all_plans ? Together::kOneAfterTheOther
                                              : Together::kNotAtAll;
        made.left.mode = made.right.mode = offers.front().mode;
        std::snprintf(made.why, sizeof made.why, "plan %d", refused);
        return made;
    }

    StereoCamera make() { return StereoCamera(left_, right_, rules_); }
    std::int64_t now_us() const { return now_us_; }
    void pass_us(std::int64_t us) { now_us_ += us; }
    Camera& right() { return right_; }

    int at_once = 1;   ///< plans
    int all_plans = 2; ///< with those of one after the other
    int plans = 0;

private:
    void open(ReplayCamera& camera, const char* port, const char* script)
    {
        ReplayOptions options;
        options.port = port;
        const Result<ReplayScript> parsed = parse_replay_script(script, "test");
        ASSERT_TRUE(parsed.ok()) << parsed.status().message();
        options.script = parsed.value();
        options.virtual_now_us = &now_us_;
        ASSERT_TRUE(camera.open(files_, options).ok());
    }

    TempFolder folder_;
    std::array<std::string, 2> paths_;
    std::array<const char*, 2> files_{};
    std::int64_t now_us_ = 0;
    ReplayCamera left_, right_;
    StereoRules rules_;
};

TEST(StereoCamera, PairsAreTheNearestFramesAndBothWhole)
{
    Rig rig("", "skew_us 9000; torn 40; drop 42");
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    ASSERT_TRUE(cameras.warm_up().ok());
    for (int k = 0; k < 20; ++k) {
        const Result<StereoFrames> pair = cameras.next();
        ASSERT_TRUE(pair.ok()) << pair.status().message();
        EXPECT_EQ(pair.value().left->verdict, FrameVerdict::kWhole);
        EXPECT_EQ(pair.value().right->verdict, FrameVerdict::kWhole);
        EXPECT_EQ(pair.value().skew_us, 9000);
    }
    EXPECT_EQ(cameras.figures().right.torn, 1U);
    EXPECT_EQ(cameras.figures().right.lost, 1U);
    EXPECT_EQ(cameras.figures().left.settling.state, SettlingState::kSettled);
    EXPECT_GT(cameras.figures().left.warming_up, 20U);
}

TEST(StereoCamera, ASlowerCameraIsPairedWithTheNearestFramesOfTheFasterOne)
{
    Rig rig("rate 30", "rate 10; skew_us 4000");
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    for (int k = 0; k < 6; ++k) {
        const Result<StereoFrames> pair = cameras.next();
        ASSERT_TRUE(pair.ok()) << pair.status().message();
        EXPECT_LE(std::llabs(pair.value().skew_us), 33'334 / 2 + 1);
    }
}

TEST(StereoCamera, ABusThatIsFullLeadsDownThePlansToOneAfterTheOther)
{
    Rig rig("", "full 1");
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    EXPECT_TRUE(cameras.one_at_a_time());
    EXPECT_EQ(cameras.figures().refused, 1);
    ASSERT_TRUE(cameras.warm_up().ok());
    const Result<StereoFrames> pair = cameras.next();
    ASSERT_TRUE(pair.ok()) << pair.status().message();
    EXPECT_GT(pair.value().skew_us, 0);
    EXPECT_EQ(cameras.figures().right.ladder.shakes[0], 0U);
}

TEST(StereoCamera, OneAfterTheOtherMayBeForbidden)
{
    StereoRules rules;
    rules.one_after_the_other = false;
    Rig full("", "full 100", rules);
    StereoCamera cameras = full.make();
    const Status status = cameras.start(full);
    EXPECT_EQ(status.fault(), Fault::kUnavailable);
    EXPECT_THAT(status.message(), HasSubstr("no bandwidth left"));
    Rig never_at_once("", "", rules);
    never_at_once.at_once = 0;
    StereoCamera others = never_at_once.make();
    EXPECT_THAT(others.start(never_at_once).message(), HasSubstr("may not stream one after the other, and plan 0"));
}

TEST(StereoCamera, ASilentCameraIsShakenAlsoWhereOneAfterTheOtherIsForbidden)
{
    StereoRules rules;
    rules.one_after_the_other = false;
    Rig rig("", "hang 0 reopen", rules);
    StereoCamera cameras = rig.make();
    const Status status = cameras.start(rig);
    EXPECT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(cameras.figures().right.ladder.recoveries, 1U);
    EXPECT_FALSE(cameras.one_at_a_time());
}

TEST(StereoCamera, AnEndThatIsAskedForComesSoon)
{
    static bool asked;
    asked = false;
    StereoRules rules;
    rules.stop_asked = []() noexcept { return asked; };
    Rig rig("", "", rules);
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    ASSERT_TRUE(cameras.next().ok());
    asked = true;
    EXPECT_EQ(cameras.warm_up().fault(), Fault::kTryAgain);
    EXPECT_EQ(cameras.start(rig).fault(), Fault::kTryAgain);
    EXPECT_LT(rig.now_us(), 3'000'000);
}

TEST(StereoCamera, APhaseOfTheWarmUpThatGaveUpIsNotForgotten)
{
    StereoRules rules;
    rules.settling.most_us = 1'000'000;
    Rig rig("dark 45", "dark 45", rules); // brightens for 1.5 s
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    ASSERT_TRUE(cameras.warm_up().ok());
    EXPECT_FALSE(cameras.figures().left.settled);
    EXPECT_EQ(cameras.figures().left.settling.state, SettlingState::kSettled);
}

TEST(StereoCamera, WithoutALockTheCamerasAreMadeAutomaticAllTheSame)
{
    constexpr const char* kManual = "control exposure_auto 1 8 1 1; control focus_auto 0 1 1 1";
    StereoRules rules;
    rules.lock_exposure = false;
    Rig rig(kManual, kManual, rules);
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    ASSERT_TRUE(cameras.warm_up().ok());
    EXPECT_EQ(rig.right().get(ControlId::kExposureAuto).value(), 8);
    EXPECT_EQ(rig.right().get(ControlId::kFocusAuto).value(), 0);
    EXPECT_FALSE(cameras.figures().lock.has_value());
}

TEST(StereoCamera, EachFrameIsUsedOnce)
{
    Rig rig("", "skew_us 3000");
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    std::uint32_t last = 0;
    for (int k = 0; k < 10; ++k) {
        const Result<StereoFrames> pair = cameras.next();
        ASSERT_TRUE(pair.ok());
        if (k > 0) {
            EXPECT_EQ(pair.value().left->sequence, last + 1);
        }
        last = pair.value().left->sequence;
    }
}

TEST(StereoCamera, WhatWasBeforeCanBePassedOver)
{
    Rig rig("", "");
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    ASSERT_TRUE(cameras.next().ok());
    rig.pass_us(500'000);
    cameras.skip_to_now();
    const Result<StereoFrames> pair = cameras.next();
    ASSERT_TRUE(pair.ok());
    EXPECT_GE(pair.value().left->start_us, 500'000);
}

TEST(StereoCamera, WhereNoPlanAsksForLessTheLadderIsTried)
{
    Rig rig("", "full 2");
    rig.all_plans = 1;
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    EXPECT_FALSE(cameras.one_at_a_time());
    EXPECT_EQ(cameras.figures().right.ladder.recoveries, 1U);
}

struct Cure
{
    const char* script;
    std::array<std::uint32_t, kShakeCount> shakes;
};

class StereoLadder : public testing::TestWithParam<Cure>
{
};

TEST_P(StereoLadder, ACameraThatStopsIsShakenUntilItDelivers)
{
    Rig rig("", GetParam().script);
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    ASSERT_TRUE(cameras.warm_up().ok());
    for (int k = 0; k < 90; ++k) {
        const Result<StereoFrames> pair = cameras.next();
        ASSERT_TRUE(pair.ok()) << pair.status().message();
        EXPECT_EQ(pair.value().skew_us, 0);
    }
    EXPECT_EQ(cameras.figures().right.ladder.shakes, GetParam().shakes);
    EXPECT_EQ(cameras.figures().right.ladder.recoveries, 1U);
    EXPECT_EQ(cameras.figures().left.ladder.recoveries, 0U);
}
INSTANTIATE_TEST_SUITE_P(Cures, StereoLadder,
                         testing::Values(Cure{"hang 100 restart", {1, 0, 0}}, Cure{"hang 100 reopen", {2, 1, 0}},
                                         Cure{"hang 100 port", {2, 2, 1}}, Cure{"gone 100 reopen", {2, 1, 0}},
                                         Cure{"hang 20 restart", {1, 0, 0}}));

TEST(StereoCamera, ADeadCameraIsAMissWithItsReasonInBoundedTime)
{
    for (const char* script : {"hang 0", "hang 2", "hang 30", "hang 100", "gone 0", "gone 3", "gone 100"}) {
        Rig rig("", script);
        StereoCamera cameras = rig.make();
        Status status = cameras.start(rig);
        if (status.ok())
            status = cameras.warm_up();
        for (int k = 0; status.ok() && k < 200; ++k)
            status = cameras.next().status();
        EXPECT_EQ(status.fault(), Fault::kUnavailable) << script;
        EXPECT_THAT(status.message(), StartsWith("camera replay/right: given up after")) << script;
        EXPECT_LT(rig.now_us(), 120'000'000) << script;
    }
}

TEST(StereoCamera, TornFramesWithoutEndAreAMissToo)
{
    std::string script;
    for (int k = 0; k < 60; ++k)
        script += "torn " + std::to_string(k) + ";";
    StereoRules rules;
    rules.most_torn = 5;
    rules.ladder.tries = {1, 1, 1};
    Rig rig(script.c_str(), "", rules);
    StereoCamera cameras = rig.make();
    const Status status = cameras.start(rig);
    EXPECT_EQ(status.fault(), Fault::kUnavailable);
    EXPECT_THAT(status.message(), HasSubstr("torn frames in a row"));
}

TEST(StereoCamera, TheRightCameraGetsTheExposureOfTheLeftOneAndKeepsItWhenOpenedAgain)
{
    constexpr const char* kLeft =
        "control exposure_auto 1 8 1 8; control exposure_time 1 5000 1 321; control gain 0 100 1 17";
    constexpr const char* kRight =
        "control exposure_auto 1 8 1 8; control exposure_time 1 5000 1 80; control gain 0 100 1 3; gone 150 reopen";
    Rig rig(kLeft, kRight);
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    ASSERT_TRUE(cameras.warm_up().ok());
    ASSERT_TRUE(cameras.figures().lock.has_value());
    EXPECT_EQ(cameras.figures().lock->differing(), 0);
    for (const LockedControl& one : cameras.figures().lock->all()) {
        if (one.id == ControlId::kExposureTime) {
            EXPECT_EQ(one.other.value, 321);
        }
        if (one.id == ControlId::kGain) {
            EXPECT_EQ(one.other.value, 17);
        }
    }
    for (int k = 0; k < 160; ++k)
        ASSERT_TRUE(cameras.next().ok());
    EXPECT_EQ(cameras.figures().right.ladder.recoveries, 1U);
}

TEST(StereoCamera, AWarmUpThatNeverSettlesEndsAtItsBound)
{
    StereoRules rules;
    rules.settling.most_us = 1'000'000;
    rules.settling.most_slope_q8 = 0;
    rules.settling.least_luma_q8 = 200 * 256; // never that bright
    Rig rig("", "", rules);
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    ASSERT_TRUE(cameras.warm_up().ok());
    EXPECT_EQ(cameras.figures().left.settling.state, SettlingState::kGaveUp);
    EXPECT_LT(rig.now_us(), 4'000'000);
}

class Taking
{
public:
    explicit Taking(const BurstRules& rules)
    {
        Arena measure;
        const Burst measured(measure, kWidth, kHeight, rules);
        block_ = std::vector<std::byte>(measure.peak() + 64);
        Arena arena{std::span<std::byte>(block_)};
        burst.emplace(arena, kWidth, kHeight, rules);
    }
    Result<BurstFigures> take(StereoCamera& cameras)
    {
        return burst->take(cameras, {left.data(), kWidth, kHeight}, {right.data(), kWidth, kHeight});
    }

    std::vector<Rgb8> left = std::vector<Rgb8>(std::size_t{kWidth} * kHeight);
    std::vector<Rgb8> right = left;
    std::optional<Burst> burst;

private:
    std::vector<std::byte> block_;
};

TEST(Burst, AveragesThePairsThatAreWithinTheSkew)
{
    Rig rig("", "skew_us 2000");
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    Taking taking({.pairs = 6});
    const Result<BurstFigures> figures = taking.take(cameras);
    ASSERT_TRUE(figures.ok()) << figures.status().message();
    EXPECT_EQ(figures.value().used, 6);
    EXPECT_EQ(figures.value().skew_us, 2000);
    EXPECT_EQ(figures.value().left.pictures, 6);
    // Files of levels 100 and 104 in turn; what the mean is depends on how many of each were in it.
    EXPECT_GE(taking.left[0].r, 100);
    EXPECT_LE(taking.left[0].r, 104);
    EXPECT_EQ(taking.left[1].r, taking.left[0].r + 1);
}

TEST(Burst, WithoutAnAverageAPairComesAsItIs)
{
    Rig rig("", "skew_us 2000");
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    Taking taking({.pairs = 6, .average = false});
    ASSERT_TRUE(taking.take(cameras).ok());
    EXPECT_TRUE(taking.left[0].r == 100 || taking.left[0].r == 104);
    EXPECT_EQ(taking.left, taking.right); // the same file on both sides
}

TEST(Burst, PairsBeyondTheSkewAreAMissWithFigures)
{
    Rig rig("", "skew_us 15000");
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    Taking taking({.pairs = 4, .most_skew_us = 10'000});
    const Result<BurstFigures> figures = taking.take(cameras);
    EXPECT_EQ(figures.status().fault(), Fault::kUnavailable);
    EXPECT_THAT(figures.status().message(),
                HasSubstr("of 4 pairs 4 began more than 10000 us apart (the nearest 15000 us)"));
}

TEST(Burst, ACameraThatDiesLateLeavesThePairsBeforeIt)
{
    Rig rig("", "gone 12");
    StereoCamera cameras = rig.make();
    ASSERT_TRUE(cameras.start(rig).ok());
    Taking taking({.pairs = 30});
    const Result<BurstFigures> figures = taking.take(cameras);
    ASSERT_TRUE(figures.ok()) << figures.status().message();
    EXPECT_GT(figures.value().used, 3);
    EXPECT_LT(figures.value().used, 12);
    EXPECT_TRUE(cameras.figures().right.ladder.gave_up);
    EXPECT_FALSE(taking.take(cameras).ok());
}

TEST(Burst, CapturingTakesNothingFromTheHeap)
{
    Rig rig("", "torn 60; hang 90 restart");
    StereoCamera cameras = rig.make();
    Taking taking({.pairs = 8});
    heap_gate::seal(heap_gate::Breach::kCount);
    bool fine = cameras.start(rig).ok() && cameras.warm_up().ok();
    for (int k = 0; k < 5; ++k)
        fine = fine && taking.take(cameras).ok();
    const std::uint64_t breaches = heap_gate::breaches();
    heap_gate::unseal();
    EXPECT_TRUE(fine);
    EXPECT_EQ(breaches, 0U);
}

} // namespace
} // namespace dicot
