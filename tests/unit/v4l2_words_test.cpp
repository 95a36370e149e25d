#include "buffer_judge.h"
#include "device.h"
#include "dicot/v4l2/v4l2_camera.h"
#include "kernel_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace dicot::v4l2 {
namespace {

using testing::HasSubstr;

TEST(V4l2Words, IntervalsAreFractionsOfSecondsRounded)
{
    EXPECT_EQ(interval_of({1, 30}), 333333U);
    EXPECT_EQ(interval_of({1001, 30000}), 333667U);
    EXPECT_EQ(interval_of({1, 15}), 666667U);
    EXPECT_EQ(interval_of({400, 1}), 4'000'000'000U);
    EXPECT_EQ(interval_of({0, 1}), 0U);
    EXPECT_EQ(interval_of({1, 0}), 0U);
    EXPECT_EQ(interval_of({0xFFFFFFFF, 1}), 0U);
    EXPECT_EQ(interval_of({0xFFFFFFFF, 0xFFFFFFFF}), 10'000'000U);
    for (const std::uint32_t interval : {1U, 333333U, 0xFFFFFFFFU})
        EXPECT_EQ(interval_of(fraction_of(interval)), interval);
}

TEST(V4l2Words, FormatsAreKnownBothWays)
{
    for (const PixelFormat format : {PixelFormat::kYuyv, PixelFormat::kMjpeg, PixelFormat::kNv12, PixelFormat::kGrey})
        EXPECT_EQ(format_of(fourcc_of(format)), format);
    EXPECT_EQ(format_of(v4l2_fourcc('J', 'P', 'E', 'G')), PixelFormat::kMjpeg);
    EXPECT_EQ(format_of(v4l2_fourcc('H', '2', '6', '4')), std::nullopt);
    EXPECT_EQ(fourcc_of(PixelFormat::kRgb24), 0U);
}

TEST(V4l2Words, ExposureModesAreUvcsBits)
{
    // V4L2: 0 auto, 1 manual, 2 shutter priority, 3 aperture priority. UVC 1.5, table 4-10: bits 1, 0, 2, 3.
    const std::array<std::int32_t, 4> uvc{2, 1, 4, 8};
    for (std::int32_t kernel = 0; kernel < 4; ++kernel) {
        EXPECT_EQ(from_kernel(ControlId::kExposureAuto, kernel), uvc[static_cast<std::size_t>(kernel)]);
        EXPECT_EQ(to_kernel(ControlId::kExposureAuto, uvc[static_cast<std::size_t>(kernel)]), kernel);
    }
    EXPECT_EQ(to_kernel(ControlId::kExposureAuto, 3), -1);
    EXPECT_EQ(from_kernel(ControlId::kExposureAuto, 9), 0);
    EXPECT_EQ(to_kernel(ControlId::kExposureTime, 156), 156);
}

TEST(V4l2Words, EveryControlHasItsOwnKernelNumber)
{
    for (int a = 0; a < kControlCount; ++a)
        for (int b = 0; b < a; ++b)
            EXPECT_NE(kernel_id(static_cast<ControlId>(a)), kernel_id(static_cast<ControlId>(b)));
    EXPECT_EQ(kernel_id(ControlId::kExposureTime), 0x009A0902U);
    EXPECT_EQ(kernel_id(ControlId::kBacklight), 0x0098091CU);
}

TEST(V4l2Words, RangesAreHeldToWhatANumberCanBe)
{
    v4l2_query_ext_ctrl told{};
    told.type = V4L2_CTRL_TYPE_INTEGER;
    told.minimum = -5'000'000'000;
    told.maximum = 5'000'000'000;
    told.step = 0;
    told.default_value = 7;
    const auto range = range_of(ControlId::kGain, told);
    ASSERT_TRUE(range);
    EXPECT_EQ(range->least, std::numeric_limits<std::int32_t>::min());
    EXPECT_EQ(range->most, std::numeric_limits<std::int32_t>::max());
    EXPECT_EQ(range->step, 1);
    EXPECT_EQ(range->usual, 7);
    told.flags = V4L2_CTRL_FLAG_INACTIVE; // as long as its automatic is on
    EXPECT_TRUE(range_of(ControlId::kGain, told));
    told.flags = V4L2_CTRL_FLAG_DISABLED;
    EXPECT_FALSE(range_of(ControlId::kGain, told));
    told.flags = V4L2_CTRL_FLAG_WRITE_ONLY;
    EXPECT_FALSE(range_of(ControlId::kGain, told));
    told.flags = 0;
    told.type = V4L2_CTRL_TYPE_STRING;
    EXPECT_FALSE(range_of(ControlId::kGain, told));
    told.type = V4L2_CTRL_TYPE_INTEGER;
    told.maximum = -6'000'000'000;
    EXPECT_EQ(range_of(ControlId::kGain, told)->most, std::numeric_limits<std::int32_t>::min());
}

struct Judged
{
    Frame frame;
    std::string flaw;
};

Judged judged(PixelFormat format, const std::vector<std::uint8_t>& mapped, std::uint32_t used, std::uint32_t flags = 0)
{
    v4l2_buffer buffer{};
    buffer.bytesused = used;
    buffer.flags = flags;
    Judged out;
    out.frame.mode = {format, 4, 2, 333333};
    char flaw[56] = {};
    judge(buffer, std::as_bytes(std::span{mapped}), out.frame, flaw);
    out.flaw = out.frame.flaw;
    return out;
}

TEST(V4l2Judge, AnUncompressedFrameIsWholeWithExactlyItsBytes)
{
    const std::vector<std::uint8_t> page(4096);
    const Judged whole = judged(PixelFormat::kYuyv, page, 16);
    EXPECT_EQ(whole.frame.verdict, FrameVerdict::kWhole);
    EXPECT_EQ(whole.frame.bytes.size(), 16U);
    EXPECT_EQ(whole.flaw, "");
    EXPECT_EQ(judged(PixelFormat::kYuyv, page, 12).flaw, "12 of 16 bytes");
    EXPECT_EQ(judged(PixelFormat::kYuyv, page, 17).frame.verdict, FrameVerdict::kTorn);
    EXPECT_EQ(judged(PixelFormat::kYuyv, page, 0).flaw, "no bytes");
    EXPECT_THAT(judged(PixelFormat::kYuyv, page, 16, V4L2_BUF_FLAG_ERROR).flaw, HasSubstr("error flag"));
}

TEST(V4l2Judge, BytesBeyondTheBufferAreNotBelieved)
{
    const std::vector<std::uint8_t> page(16);
    const Judged beyond = judged(PixelFormat::kMjpeg, page, 0xFFFFFFFF);
    EXPECT_EQ(beyond.frame.verdict, FrameVerdict::kTorn);
    EXPECT_EQ(beyond.frame.bytes.size(), 16U);
    EXPECT_EQ(judged(PixelFormat::kMjpeg, page, 0xFFFFFFFF, V4L2_BUF_FLAG_ERROR).frame.bytes.size(), 16U);
}

TEST(V4l2Judge, AJpegHasItsMarkersAndMayBePadded)
{
    const auto verdict = [](const std::vector<std::uint8_t>& bytes) {
        return judged(PixelFormat::kMjpeg, bytes, static_cast<std::uint32_t>(bytes.size())).frame.verdict;
    };
    EXPECT_EQ(verdict({0xFF, 0xD8, 1, 2, 0xFF, 0xD9}), FrameVerdict::kWhole);
    EXPECT_EQ(verdict({0xFF, 0xD8, 1, 2, 0xFF, 0xD9, 0, 0, 0}), FrameVerdict::kWhole);
    EXPECT_EQ(verdict({0xFF, 0xD8, 1, 2, 0xFF}), FrameVerdict::kTorn);
    EXPECT_EQ(verdict({0xFF, 0xD8, 1, 2, 0xFF, 0xD9, 7}), FrameVerdict::kTorn);
    EXPECT_EQ(verdict({0, 0xFF, 0xD8, 2, 0xFF, 0xD9}), FrameVerdict::kTorn);
    EXPECT_EQ(verdict({0xFF, 0xD8, 0}), FrameVerdict::kTorn);
    EXPECT_EQ(verdict({0xFF, 0xD8}), FrameVerdict::kTorn);
    EXPECT_EQ(verdict({0xFF}), FrameVerdict::kTorn);
    EXPECT_EQ(verdict({0, 0, 0, 0, 0}), FrameVerdict::kTorn);
    EXPECT_EQ(verdict({0xFF, 0xD9, 0, 0}), FrameVerdict::kTorn);
}

v4l2_buffer stamped(long seconds, long micros, std::uint32_t flags)
{
    v4l2_buffer buffer{};
    buffer.timestamp.tv_sec = seconds;
    buffer.timestamp.tv_usec = micros;
    buffer.flags = flags;
    return buffer;
}

TEST(V4l2Judge, TheStartOfExposureIsTheStampLessAnIntervalAtTheEnd)
{
    constexpr std::uint32_t kClock = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    constexpr std::int64_t kNow = 100'000'000;
    EXPECT_EQ(start_us(stamped(99, 500'000, kClock | V4L2_BUF_FLAG_TSTAMP_SRC_SOE), 333333, kNow), 99'500'000);
    EXPECT_EQ(start_us(stamped(99, 500'000, kClock | V4L2_BUF_FLAG_TSTAMP_SRC_EOF), 333333, kNow), 99'466'667);
    const std::int64_t guessed = kNow - 33'333;
    EXPECT_EQ(start_us(stamped(99, 500'000, V4L2_BUF_FLAG_TIMESTAMP_COPY), 333333, kNow), guessed);
    EXPECT_EQ(start_us(stamped(101, 0, kClock), 333333, kNow), guessed) << "the future";
    EXPECT_EQ(start_us(stamped(89, 0, kClock), 333333, kNow), guessed) << "long ago";
    EXPECT_EQ(start_us(stamped(-1, 0, kClock), 333333, kNow), guessed);
    EXPECT_EQ(start_us(stamped(std::numeric_limits<long>::max(), 0, kClock), 333333, kNow), guessed);
    EXPECT_EQ(
        start_us(stamped(99, std::numeric_limits<long>::max(), kClock | V4L2_BUF_FLAG_TSTAMP_SRC_SOE), 333333, kNow),
        99'999'999);
}

TEST(V4l2Judge, GapsOfTheSequenceAreFramesLostAndSurviveItsWrap)
{
    EXPECT_EQ(lost_between(5, 5), 0U);
    EXPECT_EQ(lost_between(5, 8), 3U);
    EXPECT_EQ(lost_between(0xFFFFFFFF, 1), 2U);
    EXPECT_EQ(lost_between(5, 4), 0U) << "a driver that counts backwards loses nothing";
    EXPECT_EQ(lost_between(900, 0), 0U);
}

TEST(V4l2Ports, AreTheLastFolderOfAnInterface)
{
    const auto port = [](const char* path) {
        const std::span<const char> text = port_in(path);
        return std::string(text.begin(), text.end());
    };
    EXPECT_EQ(port("/sys/devices/pci0000:00/0000:00:14.0/usb1/1-1/1-1.2/1-1.2:1.0"), "1-1.2");
    EXPECT_EQ(port("/sys/devices/platform/vhci_hcd.0/usb3/3-1/3-1:1.0"), "3-1");
    EXPECT_EQ(port("/sys/devices/platform/vivid.0"), "");
    EXPECT_EQ(port("/sys/devices/pci0000:00/0000:00:14.0"), "") << "not a USB interface";
    EXPECT_EQ(port(""), "");
    EXPECT_EQ(port("1-1.2:"), "");
    EXPECT_EQ(port("/x/1-1.1.1.1.1.1.1.1.1.1.1.1.1.1.1.1.1.1:1.0"), "") << "longer than a port can be";
}

TEST(V4l2Ports, NothingElseGetsIntoAPathOfSysfs)
{
    for (const char* text : {"1-1", "2-1.4.3", "10-12"})
        EXPECT_TRUE(is_port(text)) << text;
    for (const char* text : {"", "1", "1-", "-1", "../1-1", "1-1/..", "1-1..2", "platform:vivid-000", "1-1 ", "usb1"})
        EXPECT_FALSE(is_port(text)) << text;
    EXPECT_EQ(usb_place_of("../../x").bus, -1);
    EXPECT_EQ(read_usb_descriptors("..", {}), 0U);
}

TEST(V4l2Camera, WithoutACameraEveryCallFailsAtOnceAndSaysSo)
{
    V4l2Camera camera;
    const CameraMode mode{PixelFormat::kYuyv, 640, 480, 333333};
    const Status nowhere = camera.open("no such port");
    EXPECT_EQ(nowhere.fault(), Fault::kUnavailable);
    EXPECT_THAT(nowhere.message(), HasSubstr("there is no camera at 'no such port'"));
    EXPECT_EQ(camera.open("").fault(), Fault::kUnavailable);
    EXPECT_EQ(camera.open("/dev/no-such-node").fault(), Fault::kUnavailable);
    const Status null = camera.open("/dev/null");
    EXPECT_EQ(null.fault(), Fault::kUnavailable);
    EXPECT_THAT(null.message(), HasSubstr("takes no pictures"));
    EXPECT_FALSE(camera.is_open());
    EXPECT_EQ(camera.start(mode).fault(), Fault::kUnavailable);
    EXPECT_EQ(camera.next(std::numeric_limits<std::int64_t>::max()).status().fault(), Fault::kUnavailable);
    EXPECT_TRUE(camera.stop().ok());
    EXPECT_EQ(camera.get(ControlId::kGain).status().fault(), Fault::kUnavailable);
    EXPECT_EQ(camera.set(ControlId::kGain, 1).status().fault(), Fault::kUnavailable);
    EXPECT_EQ(camera.shake(Shake::kPort).fault(), Fault::kUnavailable);
}

} // namespace
} // namespace dicot::v4l2
