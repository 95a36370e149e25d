#include "dicot/camera/decode_frame.h"
#include "dicot/camera/luma.h"
#include "dicot/picture/jpeg_luma.h"
#include "dicot/picture/read_picture.h"
#include "dicot/picture/write_picture.h"
#include "noise_picture.h"
#include "picture_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace dicot {
namespace {

using test::Bytes;
using testing::ElementsAre;
using testing::HasSubstr;

Frame frame_of(const Bytes& bytes, PixelFormat format, int width, int height)
{
    return {.bytes = std::as_bytes(std::span{bytes}),
            .mode = {format, width, height, 333333},
            .verdict = FrameVerdict::kWhole};
}

std::vector<Rgb8> decoded(const Frame& frame)
{
    std::vector<Rgb8> pixels(static_cast<std::size_t>(frame.mode.width) * static_cast<std::size_t>(frame.mode.height));
    const Status status = decode_frame(frame, {pixels.data(), frame.mode.width, frame.mode.height});
    EXPECT_TRUE(status.ok()) << status.message();
    return pixels;
}

Status decode_status(const Frame& frame)
{
    std::vector<Rgb8> pixels(64 * 64);
    return decode_frame(frame, {pixels.data(), frame.mode.width, frame.mode.height});
}

TEST(DecodeFrame, YuyvIsLimitedRangeBt601)
{
    // The colour bars of BT.601: black and white, then red and a pixel beyond white, green, blue.
    const Bytes bytes{16, 128, 235, 128, 81, 90, 255, 240, 145, 54, 0, 34, 41, 240, 126, 110};
    // Red: y 65, v 112: (76309 * 65 + 104597 * 112) / 65536 = 254.4. Green at y 129: B = 150.2 - 149.3 = 0.9.
    // Y 255 under red: y 239, u -38: G = 278.3 + 14.9 - 91.1 = 202.1; B = 278.3 - 76.7 = 201.6.
    // Y 0 under green: y -16: G = -18.6 + 29.0 + 76.4 = 86.8. Blue: (76309 * 25 + 132201 * 112) / 65536 = 255.04.
    // Y 126 under blue: y 110, v -18: R = 128.1 - 28.7 = 99.4; G = 128.1 - 43.9 + 14.6 = 98.8; B = 354.
    EXPECT_THAT(decoded(frame_of(bytes, PixelFormat::kYuyv, 2, 4)),
                ElementsAre(Rgb8{0, 0, 0}, Rgb8{255, 255, 255}, Rgb8{254, 0, 0}, Rgb8{255, 202, 202}, Rgb8{0, 255, 1},
                            Rgb8{0, 87, 0}, Rgb8{0, 0, 255}, Rgb8{99, 99, 255}));
}

TEST(DecodeFrame, EveryYuvIsWithinHalfAStepOfTheRealNumbers)
{
    for (int u = 0; u < 256; u += 3)
        for (int v = 0; v < 256; v += 3) {
            Bytes bytes;
            for (int y = 0; y < 256; ++y) {
                bytes.push_back(static_cast<std::uint8_t>(y));
                bytes.push_back(static_cast<std::uint8_t>(y % 2 == 0 ? u : v));
            }
            const std::vector<Rgb8> pixels = decoded(frame_of(bytes, PixelFormat::kYuyv, 256, 1));
            for (int y = 0; y < 256; ++y) {
                const double luma = (y - 16) / 219.0;
                const double blue = (u - 128) / 224.0;
                const double red = (v - 128) / 224.0;
                const auto held = [](double part) { return std::clamp(part * 255, 0.0, 255.0); };
                const Rgb8& pixel = pixels[static_cast<std::size_t>(y)];
                ASSERT_NEAR(pixel.r, held(luma + 1.402 * red), 0.502) << y << ' ' << u << ' ' << v;
                ASSERT_NEAR(pixel.g, held(luma - 0.344136 * blue - 0.714136 * red), 0.502) << y << ' ' << u << ' ' << v;
                ASSERT_NEAR(pixel.b, held(luma + 1.772 * blue), 0.502) << y << ' ' << u << ' ' << v;
            }
        }
}

TEST(DecodeFrame, Nv12SharesItsChromaAmongFourPixels)
{
    // 4 x 2: luma rows, then one row of two pairs: neutral, and red's.
    const Bytes bytes{16, 126, 81, 16, 235, 16, 16, 81, 128, 128, 90, 240};
    EXPECT_THAT(decoded(frame_of(bytes, PixelFormat::kNv12, 4, 2)),
                ElementsAre(Rgb8{0, 0, 0}, Rgb8{128, 128, 128}, Rgb8{254, 0, 0}, Rgb8{179, 0, 0}, Rgb8{255, 255, 255},
                            Rgb8{0, 0, 0}, Rgb8{179, 0, 0}, Rgb8{254, 0, 0}));
}

TEST(DecodeFrame, GreyAndRgbArriveAsTheyAre)
{
    EXPECT_THAT(decoded(frame_of({0, 7, 255}, PixelFormat::kGrey, 3, 1)),
                ElementsAre(Rgb8{0, 0, 0}, Rgb8{7, 7, 7}, Rgb8{255, 255, 255}));
    EXPECT_THAT(decoded(frame_of({1, 2, 3, 254, 255, 0}, PixelFormat::kRgb24, 1, 2)),
                ElementsAre(Rgb8{1, 2, 3}, Rgb8{254, 255, 0}));
}

TEST(DecodeFrame, RowsGoToTheirStrideAndNothingElseIsTouched)
{
    const struct
    {
        PixelFormat format;
        Bytes bytes;
    } cases[] = {{PixelFormat::kYuyv, Bytes(16, 128)},
                 {PixelFormat::kNv12, Bytes(12, 128)},
                 {PixelFormat::kGrey, Bytes(8, 128)},
                 {PixelFormat::kRgb24, Bytes(24, 128)}};
    for (const auto& one : cases) {
        const Rgb8 untouched{11, 22, 33};
        std::vector<Rgb8> pixels(2 * 7, untouched);
        ASSERT_TRUE(decode_frame(frame_of(one.bytes, one.format, 4, 2), {pixels.data(), 4, 2, 7}).ok());
        for (std::size_t i = 0; i < pixels.size(); ++i)
            EXPECT_EQ(pixels[i] == untouched, i % 7 >= 4) << name_of(one.format) << ' ' << i;
    }
}

TEST(DecodeFrame, WhatIsNotWholeOrNotAsLargeAsItsModeIsRefused)
{
    const Bytes bytes(2 * 4 * 2, 128);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        Frame cut = frame_of(bytes, PixelFormat::kYuyv, 4, 2);
        cut.bytes = cut.bytes.first(size);
        EXPECT_EQ(decode_status(cut).fault(), Fault::kBadData) << size;
        EXPECT_EQ(luma_of(cut).status().fault(), Fault::kBadData) << size;
    }
    Frame torn = frame_of(bytes, PixelFormat::kYuyv, 4, 2);
    torn.verdict = FrameVerdict::kTorn;
    torn.flaw = "error bit";
    EXPECT_THAT(decode_status(torn).message(), HasSubstr("torn (error bit)"));
    EXPECT_EQ(luma_of(torn).status().fault(), Fault::kBadData);
    torn.verdict = FrameVerdict::kCancelled;
    EXPECT_THAT(decode_status(torn).message(), HasSubstr("cancelled"));

    const struct
    {
        PixelFormat format;
        int width, height;
        std::size_t size;
    } odd[] = {{PixelFormat::kYuyv, 3, 2, 12}, {PixelFormat::kNv12, 3, 2, 9},    {PixelFormat::kNv12, 2, 3, 9},
               {PixelFormat::kGrey, 0, 0, 0},  {PixelFormat::kGrey, -4, -4, 16}, {PixelFormat::kMjpeg, 8, 8, 0}};
    for (const auto& one : odd) {
        const Bytes of_size(one.size, 0);
        EXPECT_EQ(decode_status(frame_of(of_size, one.format, one.width, one.height)).fault(), Fault::kBadData);
    }
    std::vector<Rgb8> pixels(16);
    const Status other = decode_frame(frame_of(bytes, PixelFormat::kYuyv, 4, 2), {pixels.data(), 2, 4});
    EXPECT_THAT(other.message(), HasSubstr("4 x 2 where 2 x 4 is expected"));
}

/// Without the segments of one marker.
Bytes without(const Bytes& jpeg, std::uint8_t marker)
{
    Bytes rest{jpeg[0], jpeg[1]};
    std::size_t at = 2;
    while (jpeg[at + 1] != 0xDA) {
        const std::size_t length = 2 + jpeg[at + 2] * 256U + jpeg[at + 3];
        if (jpeg[at + 1] != marker)
            rest.insert(rest.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at),
                        jpeg.begin() + static_cast<std::ptrdiff_t>(at + length));
        at += length;
    }
    rest.insert(rest.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at), jpeg.end());
    return rest;
}

Bytes noise_jpeg(const test::TempFolder& folder, int width, int height)
{
    const std::string path = folder.write("noise.ppm", test::noise_ppm(width, height, 5));
    std::vector<Rgb8> pixels(static_cast<std::size_t>(width * height));
    EXPECT_TRUE(read_picture(path.c_str(), {pixels.data(), width, height}).ok());
    const std::string jpeg = folder.path("noise.jpg");
    EXPECT_TRUE(write_jpeg(jpeg.c_str(), {pixels.data(), width, height}, 80).ok());
    return test::bytes_of(jpeg);
}

TEST(DecodeFrame, AWebcamsJpegWithoutHuffmanTablesHasTheStandardOnes)
{
    const test::TempFolder folder;
    const Bytes whole = noise_jpeg(folder, 48, 32);
    const Bytes bare = without(whole, 0xC4);
    ASSERT_LT(bare.size() + 400, whole.size()) << "the tables are about 420 bytes";
    EXPECT_EQ(decoded(frame_of(bare, PixelFormat::kMjpeg, 48, 32)),
              decoded(frame_of(whole, PixelFormat::kMjpeg, 48, 32)));
}

TEST(DecodeFrame, MjpegIsTheJpegInItAndMayBePaddedBehind)
{
    Bytes jpeg = test::flat_jpeg({100});
    const std::vector<Rgb8> grey(64, Rgb8{228, 228, 228});
    EXPECT_EQ(decoded(frame_of(jpeg, PixelFormat::kMjpeg, 8, 8)), grey);
    jpeg.insert(jpeg.end(), 100, 0);
    EXPECT_EQ(decoded(frame_of(jpeg, PixelFormat::kMjpeg, 8, 8)), grey);
}

TEST(DecodeFrame, DamagedAndForeignMjpegIsRefused)
{
    const test::TempFolder folder;
    const Bytes whole = noise_jpeg(folder, 48, 32);
    for (std::size_t size = 0; size < whole.size(); size += 7) {
        const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_EQ(decode_status(frame_of(cut, PixelFormat::kMjpeg, 48, 32)).fault(), Fault::kBadData) << size;
    }
    EXPECT_EQ(decode_status(frame_of(whole, PixelFormat::kMjpeg, 32, 48)).fault(), Fault::kBadData);
    EXPECT_EQ(luma_of(frame_of(whole, PixelFormat::kMjpeg, 32, 48)).status().fault(), Fault::kBadData);
    const Bytes png = test::PngFile{.raster = {0, 4, 5, 6}}.bytes();
    EXPECT_THAT(decode_status(frame_of(png, PixelFormat::kMjpeg, 1, 1)).message(), HasSubstr("no JPEG"));
}

TEST(Luma, FiguresAreThoseOfTheDecodedPicture)
{
    // 8 x 4 samples only the pixels (0, 0) and (4, 0).
    Bytes bytes(2 * 8 * 4, 77);
    bytes[0] = 235;
    bytes[8] = 126;
    const Result<LumaFigures> yuyv = luma_of(frame_of(bytes, PixelFormat::kYuyv, 8, 4));
    ASSERT_TRUE(yuyv.ok());
    EXPECT_EQ(yuyv.value().samples, 2U);
    EXPECT_EQ(yuyv.value().mean_q8, (255U + 128) * 128);
    EXPECT_EQ(yuyv.value().saturated_q16, 32768U);

    const Result<LumaFigures> grey = luma_of(frame_of({249, 0, 0, 0, 250}, PixelFormat::kGrey, 5, 1));
    EXPECT_EQ(grey.value().mean_q8, 499U * 128);
    EXPECT_EQ(grey.value().saturated_q16, 32768U);

    // (77 * 10 + 150 * 20 + 29 * 30 + 128) / 256 = 18.6
    const Result<LumaFigures> rgb = luma_of(frame_of({10, 20, 30}, PixelFormat::kRgb24, 1, 1));
    EXPECT_EQ(rgb.value().mean_q8, 18U * 256);
    const Rgb8 pixel{10, 20, 30};
    EXPECT_EQ(luma_of(ImageView<const Rgb8>{&pixel, 1, 1}).mean_q8, 18U * 256);
    EXPECT_EQ(luma_of(ImageView<const Rgb8>{}).samples, 0U);
}

TEST(Luma, OfMjpegIsTheMeanOfItsBlocks)
{
    const Result<LumaFigures> bright = luma_of(frame_of(test::flat_jpeg({122}), PixelFormat::kMjpeg, 8, 8));
    ASSERT_TRUE(bright.ok()) << bright.status().message();
    EXPECT_EQ(bright.value().mean_q8, 250U * 256);
    EXPECT_EQ(bright.value().saturated_q16, 65536U);
    EXPECT_EQ(luma_of(frame_of(test::flat_jpeg({-100, 64, 64}), PixelFormat::kMjpeg, 8, 8)).value().mean_q8, 28U * 256);

    const test::TempFolder folder;
    const Bytes noise = noise_jpeg(folder, 100, 60);
    const Frame frame = frame_of(noise, PixelFormat::kMjpeg, 100, 60);
    const Result<LumaFigures> quick = luma_of(frame);
    ASSERT_TRUE(quick.ok()) << quick.status().message();
    EXPECT_EQ(quick.value().samples, 13U * 8);
    const std::vector<Rgb8> pixels = decoded(frame);
    double sum = 0;
    for (const Rgb8& pixel : pixels)
        sum += 0.299 * pixel.r + 0.587 * pixel.g + 0.114 * pixel.b;
    EXPECT_NEAR(quick.value().mean_q8 / 256.0, sum / static_cast<double>(pixels.size()), 3);
}

TEST(Luma, JpegRowsAreOneByteABlock)
{
    std::vector<std::uint8_t> seen;
    const LumaRowSink sink{&seen, [](void* to, std::span<const std::uint8_t> row) {
                               auto& all = *static_cast<std::vector<std::uint8_t>*>(to);
                               all.insert(all.end(), row.begin(), row.end());
                           }};
    const Bytes jpeg = test::flat_jpeg({100, -90, 80});
    ASSERT_TRUE(jpeg_luma(std::as_bytes(std::span{jpeg}), "p", sink).ok());
    EXPECT_THAT(seen, ElementsAre(228));
    const Bytes png = test::PngFile{.raster = {0, 4, 5, 6}}.bytes();
    EXPECT_EQ(jpeg_luma(std::as_bytes(std::span{png}), "p", sink).status().fault(), Fault::kBadData);
}

} // namespace
} // namespace dicot
