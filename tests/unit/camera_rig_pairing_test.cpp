#include "dicot/camera_rig/pairing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

namespace dicot {
namespace {

using testing::HasSubstr;
using Burst = std::vector<FrameTime>;

constexpr FrameVerdict kWhole = FrameVerdict::kWhole;
constexpr FrameVerdict kTorn = FrameVerdict::kTorn;
constexpr FrameVerdict kCancelled = FrameVerdict::kCancelled;

/// Frames at 30 a second from `first_us` on.
Burst burst(std::int64_t first_us, int frames, std::uint32_t first_sequence = 0)
{
    Burst made;
    for (int k = 0; k < frames; ++k)
        made.push_back({first_us + 33'333LL * k, kWhole, first_sequence + static_cast<std::uint32_t>(k)});
    return made;
}

TEST(CameraRigPairing, SkewIsRightMinusLeft)
{
    EXPECT_EQ(best_pair(burst(1000, 1), burst(1700, 1)).skew_us, 700);
    EXPECT_EQ(best_pair(burst(1700, 1), burst(1000, 1)).skew_us, -700);
}

TEST(CameraRigPairing, OfAConstantOffsetTheLatestPairIsTaken)
{
    const Pairing pairing = best_pair(burst(5'000'000, 5), burst(5'004'000, 5));
    EXPECT_EQ(pairing.left, 4);
    EXPECT_EQ(pairing.right, 4);
    EXPECT_EQ(pairing.skew_us, 4000);
    EXPECT_TRUE(judge_pairing(pairing, 4000).ok());
    EXPECT_FALSE(judge_pairing(pairing, 3999).ok());
}

TEST(CameraRigPairing, ABurstThatBeganTwoFramesLaterPairsByTimeNotByPlace)
{
    const Pairing pairing = best_pair(burst(0, 5), burst(2 * 33'333 - 300, 5, 700));
    EXPECT_EQ(pairing.left, 4);
    EXPECT_EQ(pairing.right, 2);
    EXPECT_EQ(pairing.skew_us, -300);
}

TEST(CameraRigPairing, OnlyWholeFramesPair)
{
    Burst left = burst(0, 3);
    Burst right = burst(100, 3);
    left[2].verdict = kTorn;
    right[1].verdict = kCancelled;
    const Pairing pairing = best_pair(left, right);
    EXPECT_EQ(pairing.left, 0);
    EXPECT_EQ(pairing.right, 0);
    EXPECT_EQ(pairing.left_count.torn, 1U);
    EXPECT_EQ(pairing.right_count.cancelled, 1U);
    EXPECT_EQ(pairing.right_count.whole, 2U);
}

TEST(CameraRigPairing, LostFramesAreCountedAcrossTheWrapOfTheSequence)
{
    Burst left = burst(0, 4);
    constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
    const std::array<std::uint32_t, 4> sequences{kMost - 2, kMost, 0, 3}; // lost: kMost - 1, 1 and 2
    for (std::size_t i = 0; i < left.size(); ++i)
        left[i].sequence = sequences[i];
    EXPECT_EQ(best_pair(left, {}).left_count.lost, 3U);
}

TEST(CameraRigPairing, AStreamThatBeginsAnewHasNoGap)
{
    Burst left = burst(0, 4, 90);
    left[2].sequence = 0;
    left[3].sequence = 1;
    EXPECT_EQ(best_pair(left, {}).left_count.lost, 0U);
}

TEST(CameraRigPairing, WithoutAWholePairTheSentenceSaysWhatEachSideDelivered)
{
    Burst left = burst(0, 5);
    for (FrameTime& frame : left)
        frame.verdict = kTorn;
    left[4].sequence = 6;
    left[0].verdict = kCancelled;
    const Pairing pairing = best_pair(left, {});
    EXPECT_FALSE(pairing.found());
    const Status status = judge_pairing(pairing, 8000);
    EXPECT_EQ(status.fault(), Fault::kTryAgain);
    EXPECT_STREQ(status.message(), "no whole pair: left torn 4, cancelled 1, lost 2 of 7; right delivered no frame");
    EXPECT_THAT(judge_pairing(best_pair({}, {}), 0).message(),
                HasSubstr("left delivered no frame; right delivered no"));
}

TEST(CameraRigPairing, ASkewAboveTheLimitIsToldWithBothFigures)
{
    const Status status = judge_pairing(best_pair(burst(23'100, 1), burst(0, 1)), 8000);
    EXPECT_EQ(status.fault(), Fault::kTryAgain);
    EXPECT_THAT(status.message(), HasSubstr("least skew, 23100 us, is above the limit of 8000 us"));
}

TEST(CameraRigPairing, AbsurdTimesDoNotOverflow)
{
    constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    const Burst left{{kLeast, kWhole, 0}};
    const Burst right{{kMost, kWhole, 0}};
    EXPECT_EQ(best_pair(left, right).skew_us, kMost);
    EXPECT_EQ(best_pair(right, left).skew_us, kLeast);
    EXPECT_FALSE(judge_pairing(best_pair(right, left), kMost).ok());
    EXPECT_FALSE(judge_pairing(best_pair(left, left), -1).ok());
    EXPECT_TRUE(judge_pairing(best_pair(left, left), 0).ok());
}

TEST(CameraRigPairing, NoWholePairIsNearerThanTheChosenOne)
{
    for (std::uint32_t seed = 1; seed <= 200; ++seed) {
        std::mt19937 random(seed);
        const auto draw = [&random] {
            Burst made;
            const auto below = [&random](int bound) {
                return static_cast<int>(random() % static_cast<unsigned>(bound));
            };
            for (int k = below(9); k > 0; --k)
                made.push_back({below(300), below(4) == 0 ? kTorn : kWhole, static_cast<std::uint32_t>(k)});
            return made;
        };
        const Burst left = draw();
        const Burst right = draw();
        const Pairing pairing = best_pair(left, right);
        std::int64_t nearest = std::numeric_limits<std::int64_t>::max();
        for (const FrameTime& l : left)
            for (const FrameTime& r : right)
                if (l.verdict == kWhole && r.verdict == kWhole)
                    nearest = std::min(nearest, std::abs(r.start_us - l.start_us));
        ASSERT_EQ(pairing.found(), nearest != std::numeric_limits<std::int64_t>::max()) << "seed " << seed;
        if (!pairing.found())
            continue;
        const FrameTime& l = left[static_cast<std::size_t>(pairing.left)];
        const FrameTime& r = right[static_cast<std::size_t>(pairing.right)];
        ASSERT_EQ(l.verdict, kWhole) << "seed " << seed;
        ASSERT_EQ(r.verdict, kWhole) << "seed " << seed;
        ASSERT_EQ(pairing.skew_us, r.start_us - l.start_us) << "seed " << seed;
        ASSERT_EQ(std::abs(pairing.skew_us), nearest) << "seed " << seed;
    }
}

} // namespace
} // namespace dicot
