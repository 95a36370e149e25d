#include "frame_ring.h"

#include "dicot/os/clock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace dicot {
namespace {

constexpr CameraMode kMode{PixelFormat::kGrey, 4, 2, 333'333};

class Ring : public testing::Test
{
protected:
    Ring()
    {
        ring_.lay_out(memory_, 4);
        ring_.begin(kMode);
    }
    /// Publishes a whole frame of 8 bytes that all have this value; false: there was no slot.
    bool publish(int value)
    {
        const int slot = ring_.take_free();
        if (slot < 0) {
            ring_.miss();
            return false;
        }
        for (std::byte& one : ring_.room(slot))
            one = static_cast<std::byte>(value);
        AssembledFrame frame;
        frame.bytes = 8;
        frame.verdict = FrameVerdict::kWhole;
        ring_.publish(slot, frame);
        return true;
    }
    static int value_of(const FrameRing::Taken& taken) { return std::to_integer<int>(taken.frame.bytes[0]); }

    std::vector<std::byte> memory_ = std::vector<std::byte>(4 * 8);
    FrameRing ring_;
};

TEST_F(Ring, FramesComeInOrderAndTellTheirMode)
{
    publish(1);
    publish(2);
    const FrameRing::Taken first = ring_.wait(0);
    const FrameRing::Taken second = ring_.wait(0);
    ASSERT_GE(first.slot, 0);
    ASSERT_GE(second.slot, 0);
    EXPECT_EQ(value_of(first), 1);
    EXPECT_EQ(value_of(second), 2);
    EXPECT_EQ(first.frame.mode, kMode);
    EXPECT_EQ(first.frame.bytes.size(), 8u);
    EXPECT_EQ(second.frame.sequence, 1u);
    EXPECT_EQ(second.frame.lost_before, 0u);
}

TEST_F(Ring, WaitingEndsAtTheDeadline)
{
    const std::int64_t before = monotonic_us();
    EXPECT_EQ(ring_.wait(before + 50'000).slot, -1);
    EXPECT_GE(monotonic_us(), before + 50'000);
    EXPECT_EQ(ring_.wait(0).slot, -1);
}

TEST_F(Ring, TheOldestUnreadFrameGivesWayAndIsCounted)
{
    for (int i = 0; i < 7; ++i)
        EXPECT_TRUE(publish(i));
    const FrameRing::Taken oldest = ring_.wait(0);
    EXPECT_EQ(value_of(oldest), 3);
    EXPECT_EQ(oldest.frame.sequence, 3u);
    EXPECT_EQ(oldest.frame.lost_before, 3u);
}

TEST_F(Ring, LentFramesAreNeverOverwritten)
{
    std::vector<FrameRing::Taken> lent;
    for (int i = 0; i < 4; ++i) {
        publish(i);
        lent.push_back(ring_.wait(0));
    }
    EXPECT_FALSE(publish(9));
    EXPECT_FALSE(publish(10));
    for (int i = 0; i < 4; ++i)
        EXPECT_EQ(value_of(lent[static_cast<std::size_t>(i)]), i);
    ring_.give_back(lent[2].slot);
    EXPECT_TRUE(publish(11));
    const FrameRing::Taken next = ring_.wait(0);
    EXPECT_EQ(value_of(next), 11);
    EXPECT_EQ(next.frame.sequence, 6u);
    EXPECT_EQ(next.frame.lost_before, 2u);
}

TEST_F(Ring, TheEndIsToldBehindTheLastFrame)
{
    publish(5);
    ring_.end();
    EXPECT_EQ(value_of(ring_.wait(0)), 5);
    const FrameRing::Taken none = ring_.wait(monotonic_us() + 60'000'000); // at once, not in a minute
    EXPECT_EQ(none.slot, -1);
    EXPECT_EQ(none.state, FrameRing::State::kEnded);
}

TEST_F(Ring, ANewStreamLeavesLentFramesReadable)
{
    publish(1);
    publish(2);
    const FrameRing::Taken lent = ring_.wait(0);
    ring_.begin(kMode);
    EXPECT_EQ(ring_.wait(0).slot, -1); // frame 2 belonged to the last stream
    for (int i = 3; i < 10; ++i)
        publish(i);
    EXPECT_EQ(value_of(lent), 1);
    EXPECT_EQ(ring_.wait(0).frame.sequence, 4u); // three slots are left for seven frames
}

TEST_F(Ring, OneFillsWhileOneReadsAndNoFrameChangesUnderItsReader)
{
    constexpr int kFrames = 20'000;
    std::atomic<bool> wrong{false};
    std::thread filler([&] {
        for (int i = 0; i < kFrames; ++i)
            publish(i & 0xFF);
        ring_.end();
    });
    std::uint32_t seen = 0;
    std::uint32_t lost = 0;
    for (;;) {
        const FrameRing::Taken taken = ring_.wait(monotonic_us() + 20'000'000);
        if (taken.slot < 0) {
            EXPECT_EQ(taken.state, FrameRing::State::kEnded);
            break;
        }
        ++seen;
        lost += taken.frame.lost_before;
        for (const std::byte one : taken.frame.bytes)
            wrong = wrong || std::to_integer<std::uint32_t>(one) != (taken.frame.sequence & 0xFF);
        ring_.give_back(taken.slot);
    }
    filler.join();
    EXPECT_FALSE(wrong);
    EXPECT_GT(seen, 0u);
    EXPECT_EQ(seen + lost, static_cast<std::uint32_t>(kFrames)); // the last frame always arrives
}

} // namespace
} // namespace dicot
