#include "dicot/camera/decode_frame.h"
#include "dicot/os/clock.h"
#include "dicot/os/heap_gate.h"
#include "dicot/replay/replay_camera.h"
#include "noise_picture.h"
#include "picture_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace dicot {
namespace {

using test::Bytes;
using testing::ElementsAre;
using testing::HasSubstr;

ReplayScript script_of(const char* text)
{
    const Result<ReplayScript> script = parse_replay_script(text, "test");
    EXPECT_TRUE(script.ok()) << script.status().message();
    return script.ok() ? script.value() : ReplayScript{};
}

TEST(ReplayScript, EveryWordIsUnderstood)
{
    const ReplayScript script =
        script_of("# a bad day\nrate 15\r\nskew_us -300; dark 10 # warm-up; not a part\n\nfull 2\n"
                  "drop 4;torn 5;hang 7 restart;gone 9 port\nhang 12\n"
                  "control gain 0 100 5 10 stuck\ncontrol exposure_time 1 5000 1 156");
    EXPECT_EQ(script.interval_100ns, 666666U);
    EXPECT_EQ(script.skew_us, -300);
    EXPECT_EQ(script.dark_frames, 10U);
    EXPECT_EQ(script.refused_starts, 2U);
    ASSERT_EQ(script.event_count, 5);
    EXPECT_EQ(script.events[0].fault, ReplayFault::kDrop);
    EXPECT_EQ(script.events[0].frame, 4U);
    EXPECT_EQ(script.events[2].cured_by, Shake::kRestart);
    EXPECT_EQ(script.events[3].fault, ReplayFault::kGone);
    EXPECT_EQ(script.events[3].cured_by, Shake::kPort);
    EXPECT_EQ(script.events[4].cured_by, std::nullopt);
    ASSERT_EQ(script.control_count, 2);
    EXPECT_TRUE(script.controls[0].stuck);
    EXPECT_FALSE(script.controls[1].stuck);
    EXPECT_EQ(script.controls[1].range.most, 5000);
}

TEST(ReplayScript, WhatItCannotDoIsToldWithTheLine)
{
    for (const char* line : {"rate",
                             "rate 0",
                             "rate 241",
                             "rate x",
                             "rate 15 16",
                             "skew_us 1000001",
                             "dark -1",
                             "explode 3",
                             "drop",
                             "drop -1",
                             "drop 99999999999999999999",
                             "drop 3 restart",
                             "gone 9 restart",
                             "hang 1 kick",
                             "control gain 0 100 5",
                             "control gain 0 100 0 5",
                             "control gain 10 0 1 5",
                             "control luck 0 1 1 0",
                             "control gain 0 9 1 5 loose",
                             "control gain 0 9 1 5; control gain 0 9 1 5"}) {
        const std::string text = std::string("rate 30\n") + line;
        const Result<ReplayScript> script = parse_replay_script(text, "replay.txt");
        ASSERT_FALSE(script.ok()) << line;
        EXPECT_EQ(script.status().fault(), Fault::kConfig);
        EXPECT_THAT(script.status().message(), HasSubstr("replay.txt: line 2: '"));
    }
    std::string many;
    for (int i = 0; i <= ReplayScript::kMostEvents; ++i)
        many += "drop 1\n";
    EXPECT_FALSE(parse_replay_script(many, "test").ok());
}

/// A folder of 4 x 2 pictures, picture k all of the value 10 k + 10, and a camera over them in a time that it owns.
class Replay : public testing::Test
{
protected:
    void open(const char* script, int pictures = 3, std::int64_t epoch_us = 1'000'000)
    {
        for (int k = 0; k < pictures; ++k) {
            Bytes file = test::text_bytes("P6 4 2 255\n");
            test::append(file, Bytes(24, static_cast<std::uint8_t>(10 * k + 10)));
            add("left" + std::to_string(k) + ".ppm", file);
        }
        const Status status = try_open(script, epoch_us);
        ASSERT_TRUE(status.ok()) << status.message();
    }
    void add(const std::string& name, const Bytes& bytes) { paths_.push_back(folder_.write(name, bytes)); }
    Status try_open(const char* script, std::int64_t epoch_us = 1'000'000)
    {
        files_.clear();
        for (const std::string& path : paths_)
            files_.push_back(path.c_str());
        return camera_.open(
            files_,
            {.port = "replay/left", .script = script_of(script), .epoch_us = epoch_us, .virtual_now_us = &now_us_});
    }
    Status start() { return camera_.start(camera_.modes()[0]); }

    /// "value@start", or the fault's number.
    std::string next(std::int64_t within_us = 500'000)
    {
        const Result<FrameLease> got = camera_.next(now_us_ + within_us);
        if (!got.ok())
            return std::to_string(got.status().exit_code());
        const Frame& frame = *got.value();
        std::string said = std::to_string(frame.bytes.empty() ? -1 : std::to_integer<int>(frame.bytes[0])) + "@" +
                           std::to_string(frame.start_us);
        if (frame.lost_before > 0)
            said += " lost " + std::to_string(frame.lost_before);
        if (frame.verdict != FrameVerdict::kWhole)
            said += std::string(" ") + name_of(frame.verdict) + " " + frame.flaw;
        return said;
    }

    const test::TempFolder folder_;
    std::vector<std::string> paths_;
    std::vector<const char*> files_;
    std::int64_t now_us_ = 1'000'000;
    ReplayCamera camera_;
};

TEST_F(Replay, PicturesArriveUnalteredInTheirOrderAtTheirTimes)
{
    open("rate 10");
    EXPECT_STREQ(camera_.identity().port.text, "replay/left");
    ASSERT_EQ(camera_.modes().size(), 1U);
    EXPECT_EQ(camera_.modes()[0], (CameraMode{PixelFormat::kRgb24, 4, 2, 1'000'000}));
    ASSERT_TRUE(start().ok());
    EXPECT_EQ(next(), "10@1000000");
    EXPECT_EQ(next(), "20@1100000");
    EXPECT_EQ(next(), "30@1200000");
    EXPECT_EQ(next(), "10@1300000") << "from the front again";
    EXPECT_EQ(now_us_, 1'300'000);
    const Result<FrameLease> got = camera_.next(now_us_ + 500'000);
    ASSERT_TRUE(got.ok());
    std::vector<Rgb8> pixels(8);
    ASSERT_TRUE(decode_frame(*got.value(), {pixels.data(), 4, 2}).ok());
    EXPECT_EQ(pixels, std::vector<Rgb8>(8, Rgb8{20, 20, 20}));
    EXPECT_EQ(got.value()->sequence, 4U);
}

TEST_F(Replay, ADeadlineIsKept)
{
    open("rate 10; skew_us 300");
    ASSERT_TRUE(start().ok());
    EXPECT_EQ(next(200), "75");
    EXPECT_EQ(now_us_, 1'000'200);
    EXPECT_EQ(next(200), "10@1000300");
    EXPECT_EQ(next(99'999), "75");
    EXPECT_EQ(next(1), "20@1100300");
}

TEST_F(Replay, ALateReaderLosesNothingAndALateStartTakesTheFrameThatIsDue)
{
    open("rate 10");
    now_us_ = 1'150'000;
    ASSERT_TRUE(start().ok());
    now_us_ = 2'000'000;
    EXPECT_EQ(next(), "30@1200000") << "frame 2 of the grid";
    EXPECT_EQ(next(), "10@1300000");
    now_us_ = 500'000; // before the epoch
    ASSERT_TRUE(camera_.stop().ok());
    ASSERT_TRUE(start().ok());
    EXPECT_EQ(next(), "10@1000000");
    EXPECT_TRUE(camera_.stop().ok());
    EXPECT_EQ(next(), "69");
}

TEST_F(Replay, DroppedAndTornFramesSaySo)
{
    open("rate 10; drop 1; drop 2; torn 3");
    ASSERT_TRUE(start().ok());
    EXPECT_EQ(next(), "10@1000000");
    EXPECT_EQ(next(), "10@1300000 lost 2 torn 12 of 24 bytes");
    EXPECT_EQ(next(), "20@1400000");
}

TEST_F(Replay, AHangLastsUntilItIsShakenHardEnough)
{
    open("rate 10; hang 1 reopen; gone 3 port; hang 5");
    ASSERT_TRUE(start().ok());
    EXPECT_EQ(next(), "10@1000000");
    EXPECT_EQ(next(), "75");
    EXPECT_EQ(now_us_, 1'500'000) << "waited to its end";
    ASSERT_TRUE(camera_.shake(Shake::kRestart).ok());
    EXPECT_EQ(next(), "75");
    ASSERT_TRUE(camera_.shake(Shake::kReopen).ok());
    EXPECT_EQ(next(), "20@2000000");
    EXPECT_EQ(next(), "69") << "gone";
    EXPECT_EQ(camera_.shake(Shake::kReopen).fault(), Fault::kUnavailable);
    EXPECT_EQ(start().fault(), Fault::kUnavailable);
    ASSERT_TRUE(camera_.shake(Shake::kPort).ok());
    ASSERT_TRUE(start().ok());
    EXPECT_EQ(next(), "30@2100000");
    EXPECT_EQ(next(), "75");
    ASSERT_TRUE(camera_.shake(Shake::kPort).ok());
    EXPECT_EQ(next(), "75") << "for ever";
}

TEST_F(Replay, AShakenCameraStreamsAgainIfItDidBefore)
{
    open("rate 10; gone 1 port");
    ASSERT_TRUE(start().ok());
    EXPECT_EQ(next(), "10@1000000");
    EXPECT_EQ(next(), "69");
    EXPECT_FALSE(camera_.shake(Shake::kReopen).ok());
    ASSERT_TRUE(camera_.shake(Shake::kPort).ok());
    EXPECT_EQ(next(), "20@1100000");
    ASSERT_TRUE(camera_.stop().ok());
    ASSERT_TRUE(camera_.shake(Shake::kPort).ok());
    EXPECT_EQ(next(), "69") << "it did not stream";
}

TEST_F(Replay, FramesRiseFromBlackAfterEachStart)
{
    open("rate 10; dark 2", 1);
    for (int round = 0; round < 2; ++round) {
        ASSERT_TRUE(start().ok());
        EXPECT_THAT(next(), HasSubstr("0@"));
        EXPECT_THAT(next(), HasSubstr("5@"));
        EXPECT_THAT(next(), HasSubstr("10@"));
    }
}

TEST_F(Replay, AFullBusRefusesTheFirstStarts)
{
    open("full 2");
    EXPECT_EQ(start().fault(), Fault::kTryAgain);
    EXPECT_EQ(start().fault(), Fault::kTryAgain);
    EXPECT_TRUE(start().ok());
}

TEST_F(Replay, LeasesStayReadableAndComeBack)
{
    open("rate 10");
    ASSERT_TRUE(start().ok());
    std::vector<FrameLease> held;
    for (int i = 0; i < ReplayCamera::kSlots; ++i) {
        Result<FrameLease> got = camera_.next(now_us_ + 500'000);
        ASSERT_TRUE(got.ok());
        held.push_back(std::move(got).value());
    }
    const Result<FrameLease> none = camera_.next(now_us_ + 500'000);
    EXPECT_EQ(none.status().fault(), Fault::kTryAgain);
    EXPECT_THAT(none.status().message(), HasSubstr("lent"));
    ASSERT_TRUE(camera_.stop().ok());
    EXPECT_EQ(std::to_integer<int>(held[1]->bytes[23]), 20);
    held.erase(held.begin());
    ASSERT_TRUE(start().ok());
    EXPECT_EQ(next(), "10@1300000") << "it is still the time of frame 3";
    EXPECT_EQ(std::to_integer<int>(held[0]->bytes[23]), 20);
}

TEST_F(Replay, ControlsHoldValuesOfTheirRange)
{
    open("control gain 0 100 5 10; control power_line 0 3 1 2 stuck");
    EXPECT_EQ(camera_.controls().size(), 2U);
    EXPECT_EQ(camera_.get(ControlId::kGain).value(), 10);
    EXPECT_EQ(camera_.set(ControlId::kGain, 43).value(), 45);
    EXPECT_EQ(camera_.get(ControlId::kGain).value(), 45);
    EXPECT_EQ(camera_.set(ControlId::kPowerLine, 1).value(), 2);
    EXPECT_EQ(camera_.set(ControlId::kFocus, 1).status().fault(), Fault::kUnavailable);
}

TEST_F(Replay, JpegArrivesAsItsBytesAndRawFramesAsYuyv)
{
    const Bytes jpeg = test::flat_jpeg({100});
    add("left.jpg", jpeg);
    ASSERT_TRUE(try_open("").ok());
    EXPECT_EQ(camera_.modes()[0].format, PixelFormat::kMjpeg);
    ASSERT_TRUE(start().ok());
    const Result<FrameLease> got = camera_.next(now_us_ + 500'000);
    ASSERT_TRUE(got.ok());
    EXPECT_TRUE(std::ranges::equal(got.value()->bytes, std::as_bytes(std::span{jpeg})));
    EXPECT_EQ(try_open("dark 3").fault(), Fault::kConfig);
}

TEST_F(Replay, ARawFramesNameTellsItsSize)
{
    Bytes raw(16);
    for (std::size_t i = 0; i < raw.size(); ++i)
        raw[i] = static_cast<std::uint8_t>(16 + i);
    add("box-4x2_000.yuyv", raw);
    ASSERT_TRUE(try_open("rate 10; dark 2").ok());
    EXPECT_EQ(camera_.modes()[0], (CameraMode{PixelFormat::kYuyv, 4, 2, 1'000'000}));
    ASSERT_TRUE(start().ok());
    const auto taken = [&] {
        const Result<FrameLease> got = camera_.next(now_us_ + 500'000);
        Bytes bytes;
        for (const std::byte byte : got.value()->bytes)
            bytes.push_back(std::to_integer<std::uint8_t>(byte));
        return bytes;
    };
    Bytes black;
    for (int i = 0; i < 8; ++i)
        test::append(black, {16, 128});
    EXPECT_EQ(taken(), black);
    // Half-lit: luma 16 + (Y - 16) / 2, chroma 128 + (C - 128) / 2.
    EXPECT_THAT(taken(), testing::Contains(16 + 14 / 2));
    EXPECT_EQ(taken(), raw);
}

TEST_F(Replay, FilesThatDoNotBelongTogetherAreRefusedByName)
{
    EXPECT_EQ(try_open("").fault(), Fault::kNoInput);
    add("a.ppm", test::text_bytes("P5 2 1 255\nab"));
    ASSERT_TRUE(try_open("").ok());
    add("b.ppm", test::text_bytes("P5 1 2 255\nab"));
    const Status other = try_open("");
    EXPECT_EQ(other.fault(), Fault::kBadData);
    EXPECT_THAT(other.message(), HasSubstr("b.ppm: is RGB24 of 1 x 2"));
    paths_.pop_back();
    paths_.push_back(folder_.path("missing.png"));
    EXPECT_EQ(try_open("").fault(), Fault::kNoInput);
    for (const char* name :
         {"left.yuyv", "3x2.yuyv", "0x0.yuyv", "left-4x.yuyv", "99999999999999x2.yuyv", "4x3.yuyv"}) {
        paths_.clear();
        add(name, Bytes(16));
        EXPECT_EQ(try_open("").fault(), Fault::kBadData) << name;
    }
}

TEST_F(Replay, AFileThatChangesMeanwhileIsATornFrame)
{
    open("rate 10", 2);
    folder_.write("left1.ppm", test::text_bytes("P6 9 9 255\n"));
    ASSERT_TRUE(start().ok());
    EXPECT_EQ(next(), "10@1000000");
    EXPECT_EQ(next(), "-1@1100000 torn the recorded picture cannot be read");
    EXPECT_EQ(next(), "10@1200000");
}

TEST_F(Replay, TwoCamerasOfOneEpochStayInStepWhicheverStartsLater)
{
    open("rate 10");
    ReplayCamera right;
    ASSERT_TRUE(right
                    .open(files_, {.port = "replay/right",
                                   .script = script_of("rate 10; skew_us 700"),
                                   .epoch_us = 1'000'000,
                                   .virtual_now_us = &now_us_})
                    .ok());
    ASSERT_TRUE(start().ok());
    now_us_ += 250'000;
    ASSERT_TRUE(right.start(right.modes()[0]).ok());
    EXPECT_EQ(next(), "10@1000000");
    EXPECT_EQ(next(), "20@1100000");
    EXPECT_EQ(next(), "30@1200000");
    EXPECT_EQ(next(), "10@1300000");
    const Result<FrameLease> got = right.next(now_us_ + 500'000);
    ASSERT_TRUE(got.ok());
    EXPECT_EQ(got.value()->start_us, 1'300'700);
    EXPECT_EQ(std::to_integer<int>(got.value()->bytes[0]), 10);
}

TEST_F(Replay, InRealTimeItSleepsUntilTheFrameIsDueAndNoLongerThanTheDeadline)
{
    open("rate 50", 1);
    const std::int64_t epoch_us = monotonic_us();
    ReplayCamera camera;
    ASSERT_TRUE(camera.open(files_, {.script = script_of("rate 50; hang 3"), .epoch_us = epoch_us}).ok());
    ASSERT_TRUE(camera.start(camera.modes()[0]).ok());
    for (int i = 0; i < 3; ++i) {
        const Result<FrameLease> got = camera.next(monotonic_us() + 2'000'000);
        ASSERT_TRUE(got.ok());
        EXPECT_GE(monotonic_us(), got.value()->start_us);
        EXPECT_EQ((got.value()->start_us - epoch_us) % 20'000, 0);
    }
    const std::int64_t deadline_us = monotonic_us() + 30'000;
    EXPECT_EQ(camera.next(deadline_us).status().fault(), Fault::kTryAgain);
    EXPECT_GE(monotonic_us(), deadline_us);
}

TEST_F(Replay, StreamingTakesNoHeap)
{
    if (!heap_gate::replaces_operator_new())
        GTEST_SKIP() << "a sanitizer brings its own operator new";
    open("rate 10; drop 1; torn 2; hang 5 reopen");
    heap_gate::seal(heap_gate::Breach::kCount);
    int frames = 0;
    for (int round = 0; round < 3; ++round) {
        const bool started = start().ok();
        for (int i = 0; i < 6; ++i)
            frames += camera_.next(now_us_ + 500'000).ok() ? 1 : 0;
        if (!started || !camera_.shake(Shake::kReopen).ok() || !camera_.stop().ok())
            break;
    }
    const std::uint64_t breaches = heap_gate::breaches();
    heap_gate::unseal();
    EXPECT_EQ(breaches, 0U);
    EXPECT_EQ(frames, 4 + 6 + 6) << "frame 1 is lost, and from frame 5 on the first round hangs";
}

TEST_F(Replay, AnotherModeIsRefusedAndAnotherRateIsNot)
{
    open("rate 10");
    CameraMode mode = camera_.modes()[0];
    mode.width = 8;
    EXPECT_EQ(camera_.start(mode).fault(), Fault::kUnavailable);
    mode = camera_.modes()[0];
    mode.interval_100ns *= 2;
    ASSERT_TRUE(camera_.start(mode).ok());
    EXPECT_EQ(next(), "10@1000000");
    EXPECT_EQ(next(), "20@1200000");
    ReplayCamera unopened;
    EXPECT_FALSE(unopened.start(mode).ok());
    EXPECT_TRUE(unopened.modes().empty());
}

} // namespace
} // namespace dicot
