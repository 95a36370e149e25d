#include "dicot/uvc_parse/descriptors.h"

#include "uvc_bytes.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>

namespace dicot {
namespace {

using test::DescriptorBytes;

Result<UvcDevice> parsed(const DescriptorBytes& bytes, std::uint8_t configuration = 0)
{
    return parse_uvc_device(bytes.bytes(), configuration);
}

void expect_bounded(const UvcDevice& device)
{
    ASSERT_LE(device.format_count, UvcDevice::kMostFormats);
    ASSERT_LE(device.frame_count, UvcDevice::kMostFrames);
    ASSERT_LE(device.alternate_count, UvcDevice::kMostAlternates);
    ASSERT_GT(device.frame_count, 0);
    ASSERT_GT(device.alternate_count, 0);
    for (const UvcFormat& format : device.usable_formats())
        ASSERT_LE(format.first_frame + format.frame_count, device.frame_count);
}

TEST(UvcDescriptors, AC270IsReadAsItsListingSays)
{
    const Result<UvcDevice> read = parsed(test::c270_bytes(), 1);
    ASSERT_TRUE(read.ok()) << read.status().message();
    const UvcDevice& c270 = read.value();
    EXPECT_EQ(c270.vendor, 0x046D);
    EXPECT_EQ(c270.product, 0x0825);
    EXPECT_EQ(c270.version, 0x0100);
    EXPECT_EQ(c270.clock_hz, 48'000'000u);
    EXPECT_EQ(c270.control_interface, 0);
    EXPECT_EQ(c270.streaming_interface, 1);
    EXPECT_EQ(c270.camera.id, 1);
    EXPECT_EQ(c270.camera.controls, 0x0Eu);
    EXPECT_EQ(c270.processing.id, 2);
    EXPECT_EQ(c270.processing.controls, 0x175Bu);
    EXPECT_EQ(c270.other_cameras, 0);
    EXPECT_EQ(c270.left_out, 0);
    EXPECT_FALSE(c270.bulk());

    ASSERT_EQ(c270.format_count, 2);
    EXPECT_EQ(c270.formats[0].format, PixelFormat::kYuyv);
    EXPECT_EQ(c270.formats[0].index, 1);
    EXPECT_EQ(c270.formats[0].frame_count, 3);
    EXPECT_EQ(c270.formats[1].format, PixelFormat::kMjpeg);
    EXPECT_EQ(c270.formats[1].index, 2);
    ASSERT_EQ(c270.formats[1].frame_count, 2);
    const UvcFrame& large = c270.frames_of(c270.formats[1])[1];
    EXPECT_EQ(large.index, 2);
    EXPECT_EQ(large.width, 1280);
    EXPECT_EQ(large.height, 960);
    EXPECT_EQ(large.interval_count, 6);
    EXPECT_EQ(large.intervals_100ns[5], 2'000'000u);

    // 1x 192 ... 1x 944, 2x 640, 2x 800, 2x 992, 3x 896, 3x 1020
    constexpr std::array<std::uint32_t, 11> told{192, 384, 512, 640, 800, 944, 1280, 1600, 1984, 2688, 3060};
    ASSERT_EQ(c270.alternate_count, told.size());
    for (std::size_t i = 0; i < told.size(); ++i) {
        EXPECT_EQ(c270.alternates[i].setting.number, i + 1);
        EXPECT_EQ(c270.alternates[i].setting.bytes_per_interval, told[i]);
        EXPECT_EQ(c270.alternates[i].setting.intervals_apart, 1u);
        EXPECT_EQ(c270.alternates[i].endpoint, 0x81);
    }
}

TEST(UvcDescriptors, AC920sH264IsLeftOutAndItsMjpegBehindItIsFound)
{
    const Result<UvcDevice> read = parsed(test::c920_bytes());
    ASSERT_TRUE(read.ok()) << read.status().message();
    const UvcDevice& c920 = read.value();
    ASSERT_EQ(c920.format_count, 2);
    EXPECT_EQ(c920.formats[1].format, PixelFormat::kMjpeg);
    EXPECT_EQ(c920.formats[1].index, 3);
    EXPECT_EQ(c920.frames_of(c920.formats[1])[0].width, 1920);
    EXPECT_EQ(c920.left_out, 1);
    EXPECT_EQ(c920.camera.controls, 0x020A2Eu);
    EXPECT_EQ(c920.alternates[1].setting.bytes_per_interval, 3072u); // 3x 1024
}

TEST(UvcDescriptors, EveryCutIsRefusedInOneSentence)
{
    for (const DescriptorBytes& camera : {test::c270_bytes(), test::c920_bytes()}) {
        for (std::size_t length = 0; length < camera.bytes().size(); ++length) {
            // A copy of exactly that size, so that AddressSanitizer sees the first byte too many.
            const std::vector<std::byte> cut(camera.bytes().begin(),
                                             camera.bytes().begin() + static_cast<std::ptrdiff_t>(length));
            const Result<UvcDevice> read = parse_uvc_device(cut, 0);
            ASSERT_FALSE(read.ok()) << length;
            EXPECT_EQ(read.status().fault(), Fault::kBadData) << length;
            EXPECT_STRNE(read.status().message(), "") << length;
        }
    }
}

TEST(UvcDescriptors, EveryCutThatTellsItsNewLengthIsReadOrRefused)
{
    const DescriptorBytes camera = test::c270_bytes();
    int read_well = 0;
    for (std::size_t length = 27; length < camera.bytes().size(); ++length) {
        std::vector<std::byte> cut(camera.bytes().begin(),
                                   camera.bytes().begin() + static_cast<std::ptrdiff_t>(length));
        cut[20] = static_cast<std::byte>((length - 18) & 0xFF);
        cut[21] = static_cast<std::byte>((length - 18) >> 8);
        const Result<UvcDevice> read = parse_uvc_device(cut, 0);
        if (read.ok()) {
            expect_bounded(read.value());
            ++read_well;
        } else {
            EXPECT_STRNE(read.status().message(), "") << length;
        }
    }
    // Whole from the first endpoint on: behind each of the 11 endpoints and 11 interfaces that follow it.
    EXPECT_EQ(read_well, 21);
}

TEST(UvcDescriptors, AnyByteMayLie)
{
    const DescriptorBytes camera = test::c270_bytes();
    for (std::size_t at = 0; at < camera.bytes().size(); ++at) {
        for (const int lie : {0, 1, 2, 3, 0x24, 0x7F, 0x80, 0xFE, 0xFF}) {
            std::vector<std::byte> lying = camera.bytes();
            lying[at] = static_cast<std::byte>(lie);
            const Result<UvcDevice> read = parse_uvc_device(lying, 0);
            if (read.ok())
                expect_bounded(read.value());
        }
    }
}

TEST(UvcDescriptors, ABulkEndpointReservesNothing)
{
    DescriptorBytes camera = test::plain_camera_head(0x0150);
    camera.input_header(1, 0x82).uncompressed(1, "NV12", 1).frame(5, 1, 640, 480, {333'333});
    camera.endpoint(0x82, 2, 512, 0).end_configuration();
    const Result<UvcDevice> read = parsed(camera);
    ASSERT_TRUE(read.ok()) << read.status().message();
    EXPECT_TRUE(read.value().bulk());
    EXPECT_EQ(read.value().version, 0x0150);
    EXPECT_EQ(read.value().alternates[0].setting.number, 0);
    EXPECT_EQ(read.value().alternates[0].setting.bytes_per_interval, 512u);
    EXPECT_EQ(read.value().formats[0].format, PixelFormat::kNv12);
}

TEST(UvcDescriptors, ASuperSpeedCompanionTellsTheBytes)
{
    DescriptorBytes camera = test::plain_camera_head();
    camera.input_header(1, 0x81).uncompressed(1, "Y800", 1).frame(5, 1, 1280, 800, {83'333});
    camera.interface(1, 1, 1, 14, 2).endpoint(0x81, 5, 1024, 2).companion(49152).end_configuration();
    const Result<UvcDevice> read = parsed(camera);
    ASSERT_TRUE(read.ok()) << read.status().message();
    EXPECT_EQ(read.value().alternates[0].setting.bytes_per_interval, 49152u);
    EXPECT_EQ(read.value().alternates[0].setting.intervals_apart, 2u);
    EXPECT_EQ(read.value().formats[0].format, PixelFormat::kGrey);
}

TEST(UvcDescriptors, TheFirstUsableCameraOfSeveralIsTaken)
{
    DescriptorBytes device;
    device.device(0x1234, 0x5678).configuration(3, 6);
    device.interface(0, 0, 0, 14, 1).control_header(0x0100, 1'000'000, {1});
    device.interface(1, 0, 0, 14, 2).input_header(1, 0x81).h264_by_frames(1, 1).frame(0x11, 1, 640, 480, {333'333});
    device.interface(1, 1, 1, 14, 2).endpoint(0x81, 5, 1024, 1);
    for (const int first : {2, 4}) {
        device.interface(first, 0, 0, 14, 1).control_header(0x0100, 2'000'000, {first + 1});
        device.interface(first + 1, 0, 0, 14, 2).input_header(1, 0x80 + first);
        device.mjpeg(1, 1).frame(7, 1, 320 * first, 240, {333'333});
        device.interface(first + 1, 1, 1, 14, 2).endpoint(0x80 + first, 1, 512, 1);
    }
    device.end_configuration();
    const Result<UvcDevice> read = parsed(device);
    ASSERT_TRUE(read.ok()) << read.status().message();
    EXPECT_EQ(read.value().control_interface, 2);
    EXPECT_EQ(read.value().streaming_interface, 3);
    EXPECT_EQ(read.value().frames[0].width, 640);
    EXPECT_EQ(read.value().other_cameras, 2);
    EXPECT_EQ(read.value().configuration, 3);
}

TEST(UvcDescriptors, TheActiveConfigurationCounts)
{
    DescriptorBytes device;
    device.device(0x1234, 0x5678);
    for (const int value : {1, 2}) {
        device.configuration(value, 2).interface(0, 0, 0, 14, 1).control_header(0x0100, 1, {1});
        device.interface(1, 0, 0, 14, 2).input_header(1, 0x81).mjpeg(1, 1).frame(7, 1, 100 * value, 100, {333'333});
        device.interface(1, 1, 1, 14, 2).endpoint(0x81, 1, 512, 1).end_configuration();
    }
    EXPECT_EQ(parsed(device, 0).value().frames[0].width, 100);
    EXPECT_EQ(parsed(device, 2).value().frames[0].width, 200);
    EXPECT_EQ(parsed(device, 3).status().fault(), Fault::kBadData);
}

TEST(UvcDescriptors, WhatCannotBeUsedSaysWhy)
{
    DescriptorBytes disk;
    disk.device(1, 2).configuration(1, 1).interface(0, 0, 2, 8, 6).endpoint(0x81, 2, 512, 0).end_configuration();
    EXPECT_EQ(parsed(disk).status().fault(), Fault::kUnavailable);
    EXPECT_STREQ(parsed(disk).status().message(), "it has no video interface");

    DescriptorBytes version = test::plain_camera_head(0x0200);
    version.end_configuration();
    EXPECT_NE(std::string{parsed(version).status().message()}.find("version 2.00"), std::string::npos);

    DescriptorBytes no_pictures = test::plain_camera_head();
    no_pictures.input_header(1, 0x81).uncompressed(1, "RGBP", 1).frame(5, 1, 640, 480, {333'333});
    no_pictures.interface(1, 1, 1, 14, 2).endpoint(0x81, 1, 512, 1).end_configuration();
    EXPECT_NE(std::string{parsed(no_pictures).status().message()}.find("no picture"), std::string::npos);

    DescriptorBytes no_endpoint = test::plain_camera_head();
    no_endpoint.input_header(1, 0x81).mjpeg(1, 1).frame(7, 1, 640, 480, {333'333});
    no_endpoint.interface(1, 1, 1, 14, 2).endpoint(0x81, 1, 0, 1);                          // no bytes
    no_endpoint.interface(1, 2, 1, 14, 2).endpoint(0x81, 1, 512, 17);                       // no such interval
    no_endpoint.interface(1, 3, 1, 14, 2).endpoint(0x82, 1, 512, 1);                        // not the video's
    no_endpoint.interface(1, 4, 1, 14, 2).endpoint(0x81, 3, 512, 1);                        // interrupt
    no_endpoint.interface(1, 5, 1, 14, 2).endpoint(0x81, 1, 0x1A00, 1).end_configuration(); // reserved multiplicity
    EXPECT_NE(std::string{parsed(no_endpoint).status().message()}.find("no usable endpoint"), std::string::npos);
}

TEST(UvcDescriptors, FramesThatNobodyCanReadAreLeftOutAndCounted)
{
    DescriptorBytes camera = test::plain_camera_head();
    camera.input_header(2, 0x81).uncompressed(1, "YUY2", 6).frame(5, 1, 641, 480, {333'333}); // pairs of pixels
    camera.frame(5, 2, 0, 480, {333'333}).frame(5, 3, 640, 9000, {333'333}).frame(5, 4, 640, 480, {0});
    camera.range_frame(5, 5, 640, 480, 500'000, 333'333, 1); // least above most
    camera.frame(5, 6, 640, 480, {0, 333'333});
    camera.uncompressed(2, "YUY2", 1, 1).frame(5, 1, 640, 480, {333'333}); // interlaced
    camera.interface(1, 1, 1, 14, 2).endpoint(0x81, 1, 512, 1).end_configuration();
    const Result<UvcDevice> read = parsed(camera);
    ASSERT_TRUE(read.ok()) << read.status().message();
    ASSERT_EQ(read.value().frame_count, 1);
    EXPECT_EQ(read.value().frames[0].index, 6);
    EXPECT_EQ(read.value().frames[0].interval_count, 1);
    EXPECT_EQ(read.value().left_out, 8); // 5 frames, 2 intervals of 0, 1 format
}

TEST(UvcDescriptors, MoreThanThereIsRoomForIsLeftOut)
{
    DescriptorBytes camera = test::plain_camera_head();
    camera.input_header(10, 0x81);
    for (int format = 1; format <= 10; ++format) {
        camera.mjpeg(format, 20);
        for (int frame = 1; frame <= 20; ++frame)
            camera.frame(7, frame, 16 * frame, 16, {333'333});
    }
    for (int alternate = 1; alternate <= 40; ++alternate)
        camera.interface(1, alternate, 1, 14, 2).endpoint(0x81, 1, 16 * alternate, 1);
    camera.end_configuration();
    const Result<UvcDevice> read = parsed(camera);
    ASSERT_TRUE(read.ok()) << read.status().message();
    expect_bounded(read.value());
    EXPECT_EQ(read.value().frame_count, UvcDevice::kMostFrames);
    EXPECT_EQ(read.value().alternate_count, UvcDevice::kMostAlternates);
    EXPECT_EQ(read.value().left_out, 2 + (160 - 96) + 8);
    std::array<CameraMode, 10> few{};
    EXPECT_EQ(modes_of(read.value(), few), 10u);
}

TEST(UvcModes, EveryModeIsFoundAgainInTheDevicesOwnNumbers)
{
    const UvcDevice c270 = parsed(test::c270_bytes()).value();
    std::array<CameraMode, 64> modes{};
    ASSERT_EQ(modes_of(c270, modes), 6u + 6u + 2u + 6u + 6u);
    EXPECT_EQ(modes[0], (CameraMode{PixelFormat::kYuyv, 640, 480, 333'333}));
    EXPECT_EQ(modes[25], (CameraMode{PixelFormat::kMjpeg, 1280, 960, 2'000'000}));
    for (std::size_t i = 0; i < 26; ++i)
        EXPECT_TRUE(place_of(c270, modes[i]).has_value()) << i;
    const auto place = place_of(c270, modes[25]);
    EXPECT_EQ(place->format_index, 2);
    EXPECT_EQ(place->frame_index, 2);
    EXPECT_EQ(place->room_bytes, std::size_t{1280} * 960 * 2);
    EXPECT_FALSE(place_of(c270, {PixelFormat::kYuyv, 1280, 960, 333'333}).has_value());
    EXPECT_FALSE(place_of(c270, {PixelFormat::kGrey, 640, 480, 333'333}).has_value());
    EXPECT_EQ(largest_frame_bytes(c270), std::size_t{1280} * 960 * 2);
}

TEST(UvcModes, ARangeOfIntervalsStandsForItsEndsAndTheUsualRates)
{
    DescriptorBytes camera = test::plain_camera_head();
    camera.input_header(1, 0x81).mjpeg(1, 1).range_frame(7, 1, 640, 480, 300'000, 700'000, 100);
    camera.interface(1, 1, 1, 14, 2).endpoint(0x81, 1, 512, 1).end_configuration();
    const UvcDevice device = parsed(camera).value();
    std::array<CameraMode, 16> modes{};
    ASSERT_EQ(modes_of(device, modes), 6u);
    constexpr std::array<std::uint32_t, 6> expected{300'000, 333'333, 400'000, 500'000, 666'666, 700'000};
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(modes[i].interval_100ns, expected[i]);
    EXPECT_TRUE(place_of(device, {PixelFormat::kMjpeg, 640, 480, 654'321}).has_value());
    EXPECT_FALSE(place_of(device, {PixelFormat::kMjpeg, 640, 480, 700'001}).has_value());
}

TEST(UvcModes, ADeviceThatClaimsHugeFramesGetsNoMoreRoomThanPixelsNeed)
{
    DescriptorBytes camera = test::plain_camera_head();
    camera.input_header(1, 0x81).mjpeg(1, 1).frame(7, 1, 640, 480, {333'333});
    camera.interface(1, 1, 1, 14, 2).endpoint(0x81, 1, 512, 1).end_configuration();
    std::vector<std::byte> bytes = camera.bytes();
    const std::size_t interval =
        bytes.size() - 16 - 4; // of the frame descriptor, before the interface and the endpoint
    for (std::size_t i = 0; i < 4; ++i)
        bytes[interval - 9 + i] = std::byte{0xFF}; // dwMaxVideoFrameBufferSize
    EXPECT_EQ(largest_frame_bytes(parse_uvc_device(bytes, 0).value()), std::size_t{640} * 480 * 2 + 65536);
}

} // namespace
} // namespace dicot
