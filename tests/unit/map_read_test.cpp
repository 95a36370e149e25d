#include "dicot/picture/read_map.h"

#include "dicot/picture/write_picture.h"
#include "picture_bytes.h"
#include "temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <vector>

namespace dicot {
namespace {

using test::Bytes;
using test::PngFile;
using test::TempFolder;
using test::text_bytes;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr float kNone = std::numeric_limits<float>::infinity();

std::span<const std::byte> view(const Bytes& file)
{
    return std::as_bytes(std::span{file});
}

/// Values from the top, or the reason why there are none.
struct Outcome
{
    Status status;
    MapHead head;
    std::vector<float> values;
};

Outcome read(const Bytes& file, double png_scale = 1)
{
    const Result<MapHead> head = map_head_bytes(view(file), "m");
    if (!head.ok())
        return {head.status(), {}, {}};
    const PictureSize& size = head.value().size;
    std::vector<float> values(static_cast<std::size_t>(size.pixels()), -1.0F);
    const Status status = read_map_bytes(view(file), "m", png_scale, {values.data(), size.width, size.height});
    return {status, head.value(), values};
}

Outcome read_well(const Bytes& file, double png_scale = 1)
{
    Outcome outcome = read(file, png_scale);
    EXPECT_TRUE(outcome.status.ok()) << outcome.status.message();
    return outcome;
}

void expect_refused(const Bytes& file, const char* says)
{
    const Outcome outcome = read(file);
    EXPECT_EQ(outcome.status.fault(), Fault::kBadData);
    EXPECT_THAT(outcome.status.message(), HasSubstr("m: "));
    EXPECT_THAT(outcome.status.message(), HasSubstr(says));
}

/// A PFM with the values in the order of the file: bottom row first.
Bytes pfm(const std::string& header, const std::vector<float>& values, std::endian order = std::endian::little)
{
    Bytes file = text_bytes(header);
    for (const float value : values) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (int i = 0; i < 4; ++i)
            file.push_back(static_cast<std::uint8_t>(bits >> (order == std::endian::little ? 8 * i : 24 - 8 * i)));
    }
    return file;
}

TEST(ReadMap, APfmIsTurnedOverSoThatRowsComeFromTheTop)
{
    const Outcome map = read_well(pfm("Pf\n2 2\n-1.0\n", {3, 4, 1, 2.25F}));
    EXPECT_EQ(map.head.kind, MapKind::kPfm);
    EXPECT_THAT(map.values, ElementsAre(1, 2.25F, 3, 4));
}

TEST(ReadMap, ThePfmsScaleTellsTheByteOrderAndNothingElse)
{
    EXPECT_THAT(read_well(pfm("Pf 2 1 1\n", {7.5F, -3}, std::endian::big)).values, ElementsAre(7.5F, -3));
    EXPECT_THAT(read_well(pfm("Pf\r\n2 1\t-0.003922\n", {7.5F, -3})).values, ElementsAre(7.5F, -3));
}

TEST(ReadMap, InfinityInAPfmIsNoDisparity)
{
    EXPECT_THAT(read_well(pfm("Pf\n2 1\n-1\n", {kNone, 5})).values, ElementsAre(kNone, 5));
}

TEST(ReadMap, APngIsDividedByItsScaleAndZeroIsNoDisparity)
{
    const Outcome wide =
        read_well(PngFile{.width = 3, .bits = 16, .colour_type = 0, .raster = {0, 0, 0, 1, 64, 255, 255}}.bytes(), 256);
    EXPECT_EQ(wide.head.kind, MapKind::kPng16);
    EXPECT_THAT(wide.values, ElementsAre(kNone, 1.25F, 65535.0F / 256));
    const Outcome narrow =
        read_well(PngFile{.width = 2, .height = 2, .colour_type = 0, .raster = {0, 10, 0, 0, 255, 1}}.bytes(), 4);
    EXPECT_EQ(narrow.head.kind, MapKind::kPng8);
    EXPECT_THAT(narrow.values, ElementsAre(2.5F, kNone, 63.75F, 0.25F));
}

TEST(ReadMap, WhatWeWriteComesBackUnchanged)
{
    const TempFolder folder;
    constexpr int kWidth = 3;
    constexpr int kHeight = 2;
    const std::vector<float> values = {0.00390625F, 17, kNone, -4.5F, 255.99609375F, 0};
    const std::string path = folder.path("map.pfm");
    const Status written = write_pfm(path.c_str(), kWidth, kHeight, [&](int y, std::span<float> row) {
        for (std::size_t x = 0; x < row.size(); ++x)
            row[x] = values[static_cast<std::size_t>(y) * kWidth + x];
    });
    ASSERT_TRUE(written.ok()) << written.message();
    std::vector<float> back(values.size());
    const Status status = read_map(path.c_str(), 1, {back.data(), kWidth, kHeight});
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(back, values);
}

TEST(ReadMap, ACutFileIsRefusedAtEveryByte)
{
    const Bytes files[] = {pfm("Pf\n2 2\n-1.0\n", {1, 2, 3, 4}),
                           PngFile{.width = 2, .bits = 16, .colour_type = 0, .raster = {0, 1, 2, 3, 4}}.bytes()};
    for (const Bytes& whole : files) {
        read_well(whole);
        for (std::size_t length = 0; length < whole.size(); ++length) {
            const Outcome cut = read(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)));
            EXPECT_EQ(cut.status.fault(), Fault::kBadData) << length << " bytes of " << whole.size();
        }
    }
}

TEST(ReadMap, WhatIsNoNumberIsRefused)
{
    expect_refused(pfm("Pf\n1 1\n-1\n", {std::numeric_limits<float>::quiet_NaN()}), "no number");
    expect_refused(pfm("Pf\n1 1\n1\n", {std::numeric_limits<float>::quiet_NaN()}, std::endian::big), "no number");
    expect_refused(pfm("Pf\n1 1\n-1\n", {-kNone}), "no number");
}

TEST(ReadMap, ABadHeaderIsRefused)
{
    expect_refused(pfm("PF\n1 1\n-1\n", {1, 2, 3}), "one channel");
    expect_refused(pfm("Pfx1 1\n-1\n", {1}), "blank");
    expect_refused(pfm("Pf\nx 1\n-1\n", {1}), "width and height");
    expect_refused(pfm("Pf\n1 -1\n-1\n", {1}), "width and height");
    expect_refused(pfm("Pf\n1 1\n0\n", {1}), "scale");
    expect_refused(pfm("Pf\n1 1\nnan\n", {1}), "scale");
    expect_refused(pfm("Pf\n1 1\n-1x\n", {1}), "scale");
    expect_refused(pfm("Pf\n" + std::string(99, '1') + " 1\n-1\n", {1}), "too long");
    expect_refused(pfm("Pf\n0 1\n-1\n", {}), "no pixels");
    expect_refused(pfm("Pf\n70000 70000\n-1\n", {1}), "70000 x 70000");
    expect_refused(text_bytes("P5 1 1 255 x"), "no disparity map");
    expect_refused({}, "empty");
}

TEST(ReadMap, APngThatIsNoMapIsRefused)
{
    expect_refused(PngFile{.raster = {0, 1, 2, 3}}.bytes(), "grey PNG");
    expect_refused(PngFile{.colour_type = 4, .raster = {0, 1, 2}}.bytes(), "grey PNG");
    expect_refused(PngFile{.bits = 4, .colour_type = 0, .raster = {0, 0x10}}.bytes(), "grey PNG");
    expect_refused(PngFile{.colour_type = 0, .interlaced = true, .raster = {0, 9}}.bytes(), "interlaced");
}

TEST(ReadMap, AnotherSizeIsRefused)
{
    const Bytes file = pfm("Pf\n2 1\n-1\n", {1, 2});
    float values[4] = {};
    const Status status = read_map_bytes(view(file), "m", 1, {values, 1, 2});
    EXPECT_EQ(status.fault(), Fault::kBadData);
    EXPECT_THAT(status.message(), HasSubstr("2 x 1 where 1 x 2"));
}

} // namespace
} // namespace dicot
