#include "dicot/picture/read_picture.h"
#include "dicot/picture/write_picture.h"

#include "temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace dicot {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 37;
constexpr int kHeight = 23;
constexpr int kStride = 41;

std::vector<Rgb8> leaf()
{
    std::vector<Rgb8> pixels(kStride * kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kStride; ++x)
            pixels[static_cast<std::size_t>(y * kStride + x)] = {static_cast<std::uint8_t>(40 + 2 * x),
                                                                 static_cast<std::uint8_t>(200 - 3 * y),
                                                                 static_cast<std::uint8_t>(30 + x + y)};
    return pixels;
}

TEST(WritePng, ReadsBackAsItWas)
{
    const test::TempFolder folder;
    const std::string path = folder.path("leaf.png");
    const std::vector<Rgb8> pixels = leaf();
    ASSERT_TRUE(write_png(path.c_str(), {pixels.data(), kWidth, kHeight, kStride}).ok());
    EXPECT_EQ(folder.files(), 1U);
    std::vector<Rgb8> back(kWidth * kHeight);
    ASSERT_TRUE(read_picture(path.c_str(), {back.data(), kWidth, kHeight}).ok());
    for (std::size_t y = 0; y < kHeight; ++y)
        for (std::size_t x = 0; x < kWidth; ++x)
            ASSERT_EQ(back[y * kWidth + x], pixels[y * kStride + x]) << x << ", " << y;
}

TEST(WritePng16, LibpngReadsEveryValueBack)
{
    const test::TempFolder folder;
    const std::string path = folder.path("map.png");
    std::vector<std::uint16_t> values(kStride * kHeight);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<std::uint16_t>(i * 69);
    ASSERT_TRUE(write_png16(path.c_str(), {values.data(), kWidth, kHeight, kStride}).ok());

    std::FILE* const file = std::fopen(path.c_str(), "rb");
    ASSERT_NE(file, nullptr);
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    EXPECT_EQ(png_get_image_width(png, info), std::uint32_t{kWidth});
    EXPECT_EQ(png_get_image_height(png, info), std::uint32_t{kHeight});
    EXPECT_EQ(png_get_bit_depth(png, info), 16);
    EXPECT_EQ(png_get_color_type(png, info), PNG_COLOR_TYPE_GRAY);
    png_bytepp rows = png_get_rows(png, info);
    for (std::size_t y = 0; y < kHeight; ++y)
        for (std::size_t x = 0; x < kWidth; ++x)
            EXPECT_EQ(rows[y][2 * x] * 256 + rows[y][2 * x + 1], values[y * kStride + x]);
    png_destroy_read_struct(&png, &info, nullptr);
    std::fclose(file);
}

TEST(WriteJpeg, LooksLikeThePictureAndBetterQualityLooksMoreLikeIt)
{
    const test::TempFolder folder;
    const std::vector<Rgb8> pixels = leaf();
    const auto error_at = [&](int quality) {
        const std::string path = folder.path("q" + std::to_string(quality) + ".jpg");
        EXPECT_TRUE(write_jpeg(path.c_str(), {pixels.data(), kWidth, kHeight, kStride}, quality).ok());
        std::vector<Rgb8> back(kWidth * kHeight);
        EXPECT_TRUE(read_picture(path.c_str(), {back.data(), kWidth, kHeight}).ok());
        double sum = 0;
        for (std::size_t y = 0; y < kHeight; ++y)
            for (std::size_t x = 0; x < kWidth; ++x)
                sum += std::abs(back[y * kWidth + x].g - pixels[y * kStride + x].g);
        return sum / (kWidth * kHeight);
    };
    const double fine = error_at(95);
    const double coarse = error_at(10);
    EXPECT_LT(fine, 2.0);
    EXPECT_LT(fine, coarse);
    EXPECT_LT(coarse, 20.0);
}

TEST(WriteJpeg, AFileLargerThanTheBufferIsWhole)
{
    const test::TempFolder folder;
    const std::string path = folder.path("noise.jpg");
    constexpr int kSide = 300;
    std::vector<Rgb8> pixels(kSide * kSide);
    std::uint32_t state = 1;
    for (Rgb8& pixel : pixels) {
        state = state * 1664525U + 1013904223U;
        pixel = {static_cast<std::uint8_t>(state >> 24), static_cast<std::uint8_t>(state >> 16),
                 static_cast<std::uint8_t>(state >> 8)};
    }
    ASSERT_TRUE(write_jpeg(path.c_str(), {pixels.data(), kSide, kSide}, 100).ok());
    EXPECT_GT(test::bytes_of(path).size(), 50'000U);
    std::vector<Rgb8> back(pixels.size());
    const Status status = read_picture(path.c_str(), {back.data(), kSide, kSide});
    EXPECT_TRUE(status.ok()) << status.message();
}

TEST(WritePfm, IsLittleEndianBottomRowFirst)
{
    const test::TempFolder folder;
    const std::string path = folder.path("map.pfm");
    std::vector<int> asked;
    const auto fill = [&](int y, std::span<float> row) {
        asked.push_back(y);
        ASSERT_EQ(row.size(), 3U);
        for (std::size_t x = 0; x < 3; ++x)
            row[x] = static_cast<float>(y) * 10.0F + static_cast<float>(x) + 0.5F;
        if (y == 0)
            row[1] = std::numeric_limits<float>::infinity();
    };
    ASSERT_TRUE(write_pfm(path.c_str(), 3, 2, fill).ok());
    const test::Bytes file = test::bytes_of(path);
    const std::string header = "Pf\n3 2\n-1.0\n";
    ASSERT_EQ(file.size(), header.size() + 24);
    EXPECT_EQ(std::string(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(header.size())), header);
    // IEEE 754 by hand: 10.5 = 0x41280000, 11.5 = 0x41380000, 12.5 = 0x41480000, 0.5 = 0x3F000000, 2.5 = 0x40200000.
    const test::Bytes expected{0, 0, 0x28, 0x41, 0, 0, 0x38, 0x41, 0, 0, 0x48, 0x41,
                               0, 0, 0x00, 0x3F, 0, 0, 0x80, 0x7F, 0, 0, 0x20, 0x40};
    EXPECT_EQ(test::Bytes(file.begin() + static_cast<std::ptrdiff_t>(header.size()), file.end()), expected);
    EXPECT_EQ(asked, (std::vector<int>{1, 0}));
}

TEST(WritePicture, EveryWriterRefusesWhatCannotBeWrittenAndLeavesNothing)
{
    const test::TempFolder folder;
    const std::vector<Rgb8> pixels = leaf();
    const std::vector<std::uint16_t> values(kWidth * kHeight);
    const ImageView<const Rgb8> picture{pixels.data(), kWidth, kHeight, kStride};
    const std::function<Status(const char*)> writers[] = {
        [&](const char* path) { return write_png(path, picture); },
        [&](const char* path) {
            return write_png16(path, {values.data(), kWidth, kHeight});
        },
        [&](const char* path) { return write_jpeg(path, picture, 80); },
        [&](const char* path) {
            return write_pfm(path, kWidth, kHeight, [](int, std::span<float> row) { row[0] = 0; });
        },
    };
    const std::string below_a_file = folder.write("plain", std::string("x")) + "/out";
    for (const auto& write : writers) {
        const Status full = write("/dev/full");
        EXPECT_EQ(full.fault(), Fault::kIoError);
        EXPECT_THAT(full.message(), HasSubstr("/dev/full: the disk is full"));
        const Status missing = write(below_a_file.c_str());
        EXPECT_EQ(missing.fault(), Fault::kCannotCreate);
        EXPECT_THAT(missing.message(), HasSubstr(below_a_file));
        EXPECT_EQ(write(folder.path("").c_str()).fault(), Fault::kCannotCreate);
    }
    EXPECT_EQ(folder.files(), 1U);
}

TEST(WritePicture, NoPixelsAreRefused)
{
    const test::TempFolder folder;
    EXPECT_FALSE(write_png(folder.path("out.png").c_str(), {nullptr, 0, 0}).ok());
    EXPECT_FALSE(write_pfm(folder.path("out.pfm").c_str(), 0, 5, [](int, std::span<float>) {}).ok());
    EXPECT_EQ(folder.files(), 0U);
}

} // namespace
} // namespace dicot
