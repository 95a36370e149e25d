#include "dicot/uvc_parse/device_clock.h"
#include "dicot/uvc_parse/stream_control.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace dicot {
namespace {

// UVC 1.5, table 4-75, by hand: offset 0 bmHint, 2 bFormatIndex, 3 bFrameIndex, 4 dwFrameInterval, 8 wKeyFrameRate,
// 10 wPFrameRate, 12 wCompQuality, 14 wCompWindowSize, 16 wDelay, 18 dwMaxVideoFrameSize, 22 dwMaxPayloadTransferSize,
// 26 dwClockFrequency, 30 bmFramingInfo, 31 bPreferedVersion, 32 bMinVersion, 33 bMaxVersion, 34 and on: UVC 1.5.
constexpr std::array<std::uint8_t, 34> kBlock{1,    0,    2, 3,    0x15, 0x16, 0x05, 0x00, 4,    0,    5,    0,
                                              6,    0,    7, 0,    8,    0,    0x00, 0x60, 0x09, 0x00, 0x00, 0x0C,
                                              0x00, 0x00, 0, 0x6C, 0xDC, 0x02, 3,    9,    10,   11};

StreamControl written()
{
    StreamControl control;
    control.hint = 1;
    control.format_index = 2;
    control.frame_index = 3;
    control.interval_100ns = 333'333;
    control.key_frame_rate = 4;
    control.p_frame_rate = 5;
    control.quality = 6;
    control.window = 7;
    control.delay_ms = 8;
    control.most_frame_bytes = 614'400;
    control.most_payload_bytes = 3072;
    control.clock_hz = 48'000'000;
    control.framing = 3;
    control.preferred_version = 9;
    control.least_version = 10;
    control.most_version = 11;
    return control;
}

TEST(StreamControl, HasTheSizeOfItsVersion)
{
    EXPECT_EQ(stream_control_bytes(0x0100), 26u);
    EXPECT_EQ(stream_control_bytes(0x010A), 26u);
    EXPECT_EQ(stream_control_bytes(0x0110), 34u);
    EXPECT_EQ(stream_control_bytes(0x0150), 48u);
}

TEST(StreamControl, EveryFieldLiesWhereTheTableSays)
{
    for (const std::size_t size : {26u, 34u, 48u}) {
        std::vector<std::byte> block(size, std::byte{0xEE});
        write_stream_control(written(), block);
        for (std::size_t i = 0; i < size; ++i)
            EXPECT_EQ(std::to_integer<int>(block[i]), i < kBlock.size() ? kBlock[i] : 0) << size << " at " << i;
    }
    EXPECT_EQ(read_stream_control(std::as_bytes(std::span{kBlock})).value(), written());
}

TEST(StreamControl, AShorterAnswerLeavesTheRestAtZero)
{
    StreamControl expected = written();
    expected.clock_hz = 0;
    expected.framing = expected.preferred_version = expected.least_version = expected.most_version = 0;
    const auto block = std::as_bytes(std::span{kBlock});
    for (const std::size_t size : {26u, 27u, 33u})
        EXPECT_EQ(read_stream_control(block.first(size)).value(), expected);
    for (std::size_t size = 0; size < 26; ++size)
        EXPECT_EQ(read_stream_control(block.first(size)).status().fault(), Fault::kBadData);
}

TEST(StreamControl, APayloadSizeWithItsSignSmearedIsMended)
{
    std::array<std::uint8_t, 34> block = kBlock;
    block[22] = 0x00;
    block[23] = 0x14;
    block[24] = 0xFF;
    block[25] = 0xFF;
    EXPECT_EQ(read_stream_control(std::as_bytes(std::span{block})).value().most_payload_bytes, 0x1400u);
}

TEST(DeviceClock, TheAgeThatTheDeviceTellsIsTakenOff)
{
    // 48 MHz: 480000 ticks are 10 ms.
    EXPECT_EQ(start_of_frame_us({1'000'000, 1'480'000}, 48'000'000, 5'000'000), 4'990'000);
    EXPECT_EQ(start_of_frame_us({1'000'000, 1'000'000}, 48'000'000, 5'000'000), 5'000'000);
}

TEST(DeviceClock, RunsOverAtTheEndOf32Bits)
{
    EXPECT_EQ(start_of_frame_us({0xFFFF'FFFF, 47'999}, 48'000'000, 5'000'000), 4'999'000);
}

TEST(DeviceClock, WhatCannotBeIsNotBelieved)
{
    EXPECT_EQ(start_of_frame_us({1'000, 900}, 48'000'000, 77), 77);    // captured after it was sent
    EXPECT_EQ(start_of_frame_us({0, 48'000'001}, 48'000'000, 77), 77); // more than a second old
    EXPECT_EQ(start_of_frame_us({0, 48'000'000}, 48'000'000, 77), 77 - 1'000'000);
    EXPECT_EQ(start_of_frame_us({1, 2}, 0, 77), 77); // no clock
}

} // namespace
} // namespace dicot
