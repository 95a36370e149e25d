#include "dicot/picture/read_picture.h"

#include "picture_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace dicot {
namespace {

using test::Bytes;
using test::PngFile;
using test::text_bytes;
using testing::ElementsAre;
using testing::HasSubstr;

std::span<const std::byte> view(const Bytes& file)
{
    return std::as_bytes(std::span{file});
}

struct Outcome
{
    Status status;
    PictureSize size;
    std::vector<Rgb8> pixels;
};

Outcome read(const Bytes& file)
{
    const Result<PictureSize> size = picture_size_bytes(view(file), "p");
    if (!size.ok())
        return {size.status(), {}, {}};
    std::vector<Rgb8> pixels(static_cast<std::size_t>(size.value().pixels()), Rgb8{1, 2, 3});
    const Status status = read_picture_bytes(view(file), "p", {pixels.data(), size.value().width, size.value().height});
    return {status, size.value(), pixels};
}

Outcome read_well(const Bytes& file)
{
    Outcome outcome = read(file);
    EXPECT_TRUE(outcome.status.ok()) << outcome.status.message();
    return outcome;
}

std::uint8_t composed(int value, int alpha)
{
    return static_cast<std::uint8_t>(std::lround(value * alpha / 255.0));
}

TEST(ReadPng, ColourGreyAndPaletteGiveTheFilesNumbers)
{
    EXPECT_THAT(read_well(PngFile{.width = 2, .raster = {0, 10, 20, 30, 255, 0, 7}}.bytes()).pixels,
                ElementsAre(Rgb8{10, 20, 30}, Rgb8{255, 0, 7}));
    EXPECT_THAT(read_well(PngFile{.width = 2, .colour_type = 0, .raster = {0, 77, 200}}.bytes()).pixels,
                ElementsAre(Rgb8{77, 77, 77}, Rgb8{200, 200, 200}));
    EXPECT_THAT(
        read_well(
            PngFile{
                .width = 3, .bits = 2, .colour_type = 3, .palette = {1, 2, 3, 40, 50, 60}, .raster = {0, 0b01000100}}
                .bytes())
            .pixels,
        ElementsAre(Rgb8{40, 50, 60}, Rgb8{1, 2, 3}, Rgb8{40, 50, 60}));
    EXPECT_THAT(read_well(PngFile{.width = 4, .bits = 1, .colour_type = 0, .raster = {0, 0b10100000}}.bytes()).pixels,
                ElementsAre(Rgb8{255, 255, 255}, Rgb8{0, 0, 0}, Rgb8{255, 255, 255}, Rgb8{0, 0, 0}));
    EXPECT_THAT(read_well(PngFile{.width = 2, .bits = 4, .colour_type = 0, .raster = {0, 0x3C}}.bytes()).pixels,
                ElementsAre(Rgb8{51, 51, 51}, Rgb8{204, 204, 204}));
}

TEST(ReadPng, TransparencyIsComposedOnBlack)
{
    Bytes rgba{0};
    Bytes grey_alpha{0};
    std::vector<Rgb8> expected_rgba;
    std::vector<Rgb8> expected_grey;
    for (int i = 0; i < 256; ++i) {
        const int value = i * 7 % 256;
        const int alpha = i;
        test::append(rgba, {static_cast<std::uint8_t>(value), 255, static_cast<std::uint8_t>(255 - value),
                            static_cast<std::uint8_t>(alpha)});
        test::append(grey_alpha, {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(alpha)});
        expected_rgba.push_back({composed(value, alpha), composed(255, alpha), composed(255 - value, alpha)});
        const std::uint8_t grey = composed(value, alpha);
        expected_grey.push_back({grey, grey, grey});
    }
    EXPECT_EQ(read_well(PngFile{.width = 256, .colour_type = 6, .raster = rgba}.bytes()).pixels, expected_rgba);
    EXPECT_EQ(read_well(PngFile{.width = 256, .colour_type = 4, .raster = grey_alpha}.bytes()).pixels, expected_grey);
    EXPECT_THAT(read_well(PngFile{.width = 2,
                                  .colour_type = 3,
                                  .palette = {100, 200, 50, 9, 8, 7},
                                  .transparency = {51},
                                  .raster = {0, 0, 1}}
                              .bytes())
                    .pixels,
                ElementsAre(Rgb8{20, 40, 10}, Rgb8{9, 8, 7}));
    EXPECT_THAT(
        read_well(PngFile{.width = 2, .colour_type = 0, .transparency = {0, 90}, .raster = {0, 90, 91}}.bytes()).pixels,
        ElementsAre(Rgb8{0, 0, 0}, Rgb8{91, 91, 91}));
}

TEST(ReadPicture, SixteenBitsAreRoundedTheSameInPngAndPgm)
{
    Bytes raster;
    Bytes pgm = text_bytes("P5 256 256 65535\n");
    for (int y = 0; y < 256; ++y) {
        raster.push_back(0);
        for (int x = 0; x < 256; ++x) {
            test::append(raster, {static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(x)});
            test::append(pgm, {static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(x)});
        }
    }
    const Outcome png =
        read_well(PngFile{.width = 256, .height = 256, .bits = 16, .colour_type = 0, .raster = raster}.bytes());
    const Outcome pnm = read_well(pgm);
    for (int value = 0; value < 65536; ++value) {
        const auto expected = static_cast<std::uint8_t>(std::lround(value * 255.0 / 65535.0));
        ASSERT_EQ(png.pixels[static_cast<std::size_t>(value)].r, expected) << value;
        ASSERT_EQ(pnm.pixels[static_cast<std::size_t>(value)], (Rgb8{expected, expected, expected})) << value;
    }
}

TEST(ReadPng, InterlacedIsTheSamePicture)
{
    constexpr std::uint32_t kWidth = 13;
    constexpr std::uint32_t kHeight = 9;
    const auto append_pixel = [](Bytes& to, std::uint32_t x, std::uint32_t y) {
        test::append(to, {static_cast<std::uint8_t>(x * 19), static_cast<std::uint8_t>(y * 27),
                          static_cast<std::uint8_t>(x * y)});
    };
    Bytes plain;
    for (std::uint32_t y = 0; y < kHeight; ++y) {
        plain.push_back(0);
        for (std::uint32_t x = 0; x < kWidth; ++x)
            append_pixel(plain, x, y);
    }
    // Adam7 (RFC 2083, 2.6): first column, first row, column step, row step of each pass.
    constexpr std::uint32_t kPasses[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                             {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
    Bytes interlaced;
    for (const auto& pass : kPasses) {
        for (std::uint32_t y = pass[1]; y < kHeight; y += pass[3]) {
            interlaced.push_back(0);
            for (std::uint32_t x = pass[0]; x < kWidth; x += pass[2])
                append_pixel(interlaced, x, y);
        }
    }
    const Outcome expected = read_well(PngFile{.width = kWidth, .height = kHeight, .raster = plain}.bytes());
    const Outcome got =
        read_well(PngFile{.width = kWidth, .height = kHeight, .interlaced = true, .raster = interlaced}.bytes());
    EXPECT_EQ(got.pixels, expected.pixels);
    EXPECT_EQ(got.pixels[2 * kWidth + 3], (Rgb8{57, 54, 6}));
}

TEST(ReadPng, AnyChangedByteIsRefused)
{
    const Bytes good =
        PngFile{.width = 3, .height = 2, .raster = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9}}
            .bytes();
    ASSERT_TRUE(read(good).status.ok());
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (const int bit : {0, 5, 7}) {
            Bytes bad = good;
            bad[i] = static_cast<std::uint8_t>(bad[i] ^ 1U << bit);
            EXPECT_EQ(read(bad).status.fault(), Fault::kBadData) << "byte " << i << ", bit " << bit;
        }
    }
}

TEST(ReadJpeg, GreyIsTheBlocksLevel)
{
    const Outcome picture = read_well(test::flat_jpeg({100}));
    EXPECT_EQ(picture.size.width, 8);
    EXPECT_EQ(picture.size.height, 8);
    EXPECT_EQ(picture.pixels, std::vector<Rgb8>(64, Rgb8{228, 228, 228}));
}

TEST(ReadJpeg, ColourFollowsTheJfifEquations)
{
    // R = Y + 1.402 (Cr - 128), G = Y - 0.344136 (Cb - 128) - 0.714136 (Cr - 128), B = Y + 1.772 (Cb - 128), clamped.
    for (const std::vector<int>& levels :
         {std::vector<int>{70, -64, -64}, {-64, 64, 64}, {90, 70, -110}, {64, -100, 80}}) {
        const double luma = 128.0 + levels[0];
        const auto channel = [](double value) { return static_cast<int>(std::lround(std::clamp(value, 0.0, 255.0))); };
        const Outcome picture = read_well(test::flat_jpeg(levels));
        ASSERT_EQ(picture.pixels.size(), 64U);
        for (const Rgb8& pixel : picture.pixels) {
            EXPECT_NEAR(pixel.r, channel(luma + 1.402 * levels[2]), 1);
            EXPECT_NEAR(pixel.g, channel(luma - 0.344136 * levels[1] - 0.714136 * levels[2]), 1);
            EXPECT_NEAR(pixel.b, channel(luma + 1.772 * levels[1]), 1);
        }
    }
}

TEST(ReadJpeg, CmykIsRefusedWithTheRemedy)
{
    const Outcome outcome = read(test::flat_jpeg({70, 80, 90, 100}));
    EXPECT_EQ(outcome.status.fault(), Fault::kBadData);
    EXPECT_THAT(outcome.status.message(), HasSubstr("CMYK"));
    EXPECT_THAT(outcome.status.message(), HasSubstr("convert it to RGB"));
}

TEST(ReadJpeg, PaddingInFrontOfTheEndMarkerIsNoDamage)
{
    Bytes padded = test::flat_jpeg({100});
    padded.insert(padded.end() - 2, 40, 0);
    EXPECT_EQ(read_well(padded).pixels, std::vector<Rgb8>(64, Rgb8{228, 228, 228}));
}

TEST(ReadJpeg, MissingBlocksAreRefusedThoughTheEndMarkerIsThere)
{
    Bytes torn = test::flat_jpeg({100, 90, 80}); // 27 bits in 4 bytes; libjpeg would only warn and invent the rest
    torn.erase(torn.end() - 5, torn.end() - 2);
    EXPECT_EQ(read(torn).status.fault(), Fault::kBadData);
}

TEST(ReadPnm, BinaryAndPlainColourAndGreyWithComments)
{
    Bytes p6 = text_bytes("P6\n# made by hand\n2 1 # two pixels\n255\n");
    test::append(p6, {1, 2, 3, 254, 255, 0});
    EXPECT_THAT(read_well(p6).pixels, ElementsAre(Rgb8{1, 2, 3}, Rgb8{254, 255, 0}));
    EXPECT_THAT(read_well(text_bytes("P3 1 2 255 1 2 3\n4 5 6")).pixels, ElementsAre(Rgb8{1, 2, 3}, Rgb8{4, 5, 6}));
    EXPECT_THAT(read_well(text_bytes("P2 3 1 15 0 7 15\n")).pixels,
                ElementsAre(Rgb8{0, 0, 0}, Rgb8{119, 119, 119}, Rgb8{255, 255, 255}));
    EXPECT_THAT(read_well(text_bytes("P5 2 1 255\n#A")).pixels, ElementsAre(Rgb8{35, 35, 35}, Rgb8{65, 65, 65}))
        << "a # is a pixel where pixels begin";
    Bytes p6_wide = text_bytes("P6 1 1 65535\n");
    test::append(p6_wide, {0xFF, 0xFF, 0x80, 0x80, 0x00, 0x80});
    EXPECT_THAT(read_well(p6_wide).pixels, ElementsAre(Rgb8{255, 128, 0}));
}

TEST(ReadPnm, NonsenseIsRefused)
{
    for (const char* text :
         {"P3 1 1 255 1 2 300", "P3 1 1 0 0 0 0", "P3 1 1 65536 1 1 1", "P3 x 1 255 1 2 3", "P3 -1 1 255 1 2 3",
          "P3 1 1 255 1 2 x", "P3 1 1 255 1 2", "P6 0 5 255\n", "P5 1 1", "P5 1 1 255", "P5 1 1 255\n",
          "P3 1 1 255 1 2 3x", "P512 3 255 ", "P3 99999999999999999999 1 255 1 2 3"})
        EXPECT_EQ(read(text_bytes(text)).status.fault(), Fault::kBadData) << text;
}

TEST(ReadPicture, TheLimitsAreToldWithTheSize)
{
    const Bytes png = PngFile{.width = 70000, .height = 70000}.bytes();
    Bytes jpeg = test::flat_jpeg({100});
    const Bytes marker{0xFF, 0xC0};
    const auto frame = std::search(jpeg.begin(), jpeg.end(), marker.begin(), marker.end());
    ASSERT_NE(frame, jpeg.end());
    std::fill(frame + 5, frame + 9, std::uint8_t{0xFF});
    Bytes jpeg_wide = test::flat_jpeg({100});
    jpeg_wide[static_cast<std::size_t>(frame - jpeg.begin()) + 7] = 0x40;
    jpeg_wide[static_cast<std::size_t>(frame - jpeg.begin()) + 8] = 0x01;
    const struct
    {
        Bytes file;
        const char* told;
    } cases[] = {
        {png, "70000 x 70000"},
        {text_bytes("P6 70000 70000 255\n"), "70000 x 70000"},
        {text_bytes("P6 16384 4097 255\n"), "16384 x 4097"},
        {text_bytes("P6 16385 1 255\n"), "16385 x 1"},
        {jpeg, "65535 x 65535"},
        {jpeg_wide, "16385 x 8"},
    };
    for (const auto& one : cases) {
        const Outcome outcome = read(one.file);
        EXPECT_EQ(outcome.status.fault(), Fault::kBadData) << one.told;
        EXPECT_THAT(outcome.status.message(), HasSubstr(one.told));
        EXPECT_THAT(outcome.status.message(), HasSubstr("the largest is 16384"));
    }
    const Result<PictureSize> largest = picture_size_bytes(view(text_bytes("P6 16384 4096 255\n")), "p");
    ASSERT_TRUE(largest.ok()) << largest.status().message();
    EXPECT_EQ(largest.value().pixels(), kMaxPicturePixels);
}

TEST(ReadPicture, OnePixelIsAPicture)
{
    EXPECT_THAT(read_well(PngFile{.raster = {0, 4, 5, 6}}.bytes()).pixels, ElementsAre(Rgb8{4, 5, 6}));
    EXPECT_THAT(read_well(text_bytes("P3 1 1 255 4 5 6")).pixels, ElementsAre(Rgb8{4, 5, 6}));
}

TEST(ReadPicture, AnotherSizeThanTheCallersIsRefused)
{
    const Bytes file = PngFile{.width = 2, .raster = {0, 1, 2, 3, 4, 5, 6}}.bytes();
    std::vector<Rgb8> pixels(4);
    const Status status = read_picture_bytes(view(file), "left.png", {pixels.data(), 2, 2});
    EXPECT_EQ(status.fault(), Fault::kBadData);
    EXPECT_THAT(status.message(), HasSubstr("left.png: the picture is 2 x 1 where 2 x 2 is expected"));
}

TEST(ReadPicture, RowsGoToTheirStrideAndNothingElseIsTouched)
{
    Bytes raster;
    for (std::uint8_t y = 0; y < 8; ++y) {
        raster.push_back(0);
        test::append(raster, Bytes(24, y));
    }
    Bytes p5 = text_bytes("P5 8 8 255\n");
    test::append(p5, Bytes(64, 9));
    for (const Bytes& file : {PngFile{.width = 8, .height = 8, .raster = raster}.bytes(), test::flat_jpeg({100}), p5}) {
        const Rgb8 untouched{11, 22, 33};
        std::vector<Rgb8> pixels(8 * 12, untouched);
        ASSERT_TRUE(read_picture_bytes(view(file), "p", {pixels.data(), 8, 8, 12}).ok());
        for (std::size_t y = 0; y < 8; ++y)
            for (std::size_t x = 8; x < 12; ++x)
                EXPECT_EQ(pixels[y * 12 + x], untouched);
        EXPECT_NE(pixels[12], untouched);
    }
}

TEST(ReadPicture, EmptyAndForeignFilesAreToldApart)
{
    EXPECT_THAT(read({}).status.message(), HasSubstr("empty"));
    for (const char* text : {"GIF89a......", "hello", "P7\nWIDTH 1\n", "P1 1 1 0", "\x89PNX", "<svg/>"}) {
        const Outcome outcome = read(text_bytes(text));
        EXPECT_EQ(outcome.status.fault(), Fault::kBadData) << text;
        EXPECT_THAT(outcome.status.message(), HasSubstr("no picture that dicot reads")) << text;
    }
}

TEST(ReadPicture, WhatCannotBeReadIsNoInputWithTheName)
{
    const test::TempFolder folder;
    const std::string paths[] = {folder.path("missing.png"), folder.path("")};
    for (const std::string& path : paths) {
        Rgb8 pixel{};
        const Status statuses[] = {picture_size(path.c_str()).status(), read_picture(path.c_str(), {&pixel, 1, 1})};
        for (const Status& status : statuses) {
            EXPECT_EQ(status.fault(), Fault::kNoInput);
            EXPECT_THAT(status.message(), HasSubstr(path));
        }
    }
}

TEST(ReadPicture, TheContentDecidesNotTheName)
{
    const test::TempFolder folder;
    const std::string path = folder.write("really-a-png.jpg", PngFile{.raster = {0, 4, 5, 6}}.bytes());
    Rgb8 pixel{};
    ASSERT_TRUE(read_picture(path.c_str(), {&pixel, 1, 1}).ok());
    EXPECT_EQ(pixel, (Rgb8{4, 5, 6}));
}

} // namespace
} // namespace dicot
