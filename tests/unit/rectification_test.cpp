#include "rendered_maps.h"

#include "dicot/base/crc32.h"
#include "dicot/rectification/rectify.h"
#include "dicot/rectification/remap_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace dicot {
namespace {

using test::map_of;
using test::rendered_rig;

/// OpenCV's projection of a point, written out.
Point2 projected(const Lens& lens, const Point3& point)
{
    const double x = point.x / point.z, y = point.y / point.z, r2 = x * x + y * y;
    const auto& k = lens.k;
    const double scale =
        (1 + k[0] * r2 + k[1] * r2 * r2 + k[4] * r2 * r2 * r2) / (1 + k[5] * r2 + k[6] * r2 * r2 + k[7] * r2 * r2 * r2);
    return {lens.fx * (x * scale + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x)) + lens.cx,
            lens.fy * (y * scale + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y) + lens.cy};
}

struct Built
{
    test::Memory memory;
    Arena arena;
    RemapTable table;
    std::vector<RemapSpan> spans;

    Built(const LensMap& map, int width, int height)
        : memory(RemapTable::most_bytes(width, height)), arena(memory.arena())
    {
        Result<RemapTable> made = RemapTable::build(map, width, height, arena, "rig.yaml");
        EXPECT_TRUE(made.ok()) << made.status().message();
        if (made.ok())
            table = made.value();
        spans.resize(static_cast<std::size_t>(width));
    }
};

TEST(Rectify, APointLiesOnOneRowAndItsDisparityIsItsDepth)
{
    const StereoRig rig = rendered_rig();
    const Rectification flat = rectify(rig, kCrop, "rig.yaml").value();
    const LensMap left = map_of(rig.left, flat.left_rectifying, flat),
                  right = map_of(rig.right, flat.right_rectifying, flat);
    std::mt19937 random{7};
    std::uniform_real_distribution<double> side(-150, 150), depth(400, 1500);
    for (int i = 0; i < 1000; ++i) {
        const Point3 in_left{side(random), side(random), depth(random)};
        const Point3 in_right = rig.into_right(in_left);
        const auto in_flat = turned(flat.left_rectifying, in_left);
        const double x = flat.focal_px * in_flat.x / in_flat.z + flat.cx_px,
                     y = flat.focal_px * in_flat.y / in_flat.z + flat.cy_px;
        const double disparity = flat.focal_px * flat.baseline_mm / in_flat.z;
        const Point2 from_left = left.source_of(x, y), from_right = right.source_of(x - disparity, y);
        const Point2 seen_left = projected(rig.left, in_left), seen_right = projected(rig.right, in_right);
        ASSERT_NEAR(from_left.x, seen_left.x, 1e-8);
        ASSERT_NEAR(from_left.y, seen_left.y, 1e-8);
        ASSERT_NEAR(from_right.x, seen_right.x, 1e-8) << "T or R is used the wrong way round";
        ASSERT_NEAR(from_right.y, seen_right.y, 1e-8);
    }
    EXPECT_NEAR(flat.baseline_mm,
                std::sqrt(84.985154252604417 * 84.985154252604417 + 1.0246794468807228 * 1.0246794468807228 +
                          1.21391461486277 * 1.21391461486277),
                1e-9);
}

TEST(Rectify, EachCameraTurnsHalfTheWay)
{
    // 20 degrees about the vertical, with the baseline exactly half-way between: 10 degrees each, and nothing else.
    const double c = std::cos(20 * M_PI / 180), s = std::sin(20 * M_PI / 180);
    StereoRig rig;
    rig.width = 640;
    rig.height = 480;
    rig.left = rig.right = {600, 600, 319.5, 239.5, {}};
    rig.turn = {c, 0, s, 0, 1, 0, -s, 0, c};
    rig.shift_mm = {-100 * std::cos(10 * M_PI / 180), 0, 100 * std::sin(10 * M_PI / 180)};
    const Rectification flat = rectify(rig, kCrop, "rig.yaml").value();
    EXPECT_NEAR(flat.left_rectifying[2], std::sin(10 * M_PI / 180), 1e-12);
    EXPECT_NEAR(flat.right_rectifying[2], -std::sin(10 * M_PI / 180), 1e-12);
    EXPECT_NEAR(flat.left_rectifying[4], 1, 1e-12);
    EXPECT_NEAR(flat.baseline_mm, 100, 1e-9);
}

TEST(Rectify, ParallelCamerasStayAsTheyAre)
{
    StereoRig rig;
    rig.width = 640;
    rig.height = 480;
    rig.left = rig.right = {500, 500, 319.5, 239.5, {}};
    rig.turn = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    rig.shift_mm = {-60, 0, 0};
    const Rectification flat = rectify(rig, kKeepAll, "rig.yaml").value();
    EXPECT_NEAR(flat.focal_px, 500, 1e-6);
    EXPECT_NEAR(flat.cx_px, 319.5, 1e-6);
    EXPECT_NEAR(flat.cy_px, 239.5, 1e-6);
    EXPECT_NEAR(flat.left_rectifying[0], 1, 1e-15);
}

TEST(Rectify, CropLeavesNoPixelWithoutSourceAndKeepAllLosesNone)
{
    const StereoRig rig = rendered_rig();
    const Rectification crop = rectify(rig, kCrop, "rig.yaml").value();
    const Rectification whole = rectify(rig, kKeepAll, "rig.yaml").value();
    EXPECT_GT(crop.focal_px, whole.focal_px);
    for (const auto& [camera, turn] :
         {std::pair{&rig.left, &crop.left_rectifying}, std::pair{&rig.right, &crop.right_rectifying}}) {
        const Built built(map_of(*camera, *turn, crop), 1280, 720);
        EXPECT_EQ(built.table.pixels_with_source(), 1280 * 720);
    }
    for (const double x : {0.0, 1279.0})
        for (const double y : {0.0, 719.0}) {
            const Point2 seen = undistort(rig.left, {x, y}).value();
            const auto ray = turned(whole.left_rectifying, {seen.x, seen.y, 1});
            const double u = whole.focal_px * ray.x / ray.z + whole.cx_px,
                         v = whole.focal_px * ray.y / ray.z + whole.cy_px;
            EXPECT_TRUE(u > -0.01 && u < 1279.01 && v > -0.01 && v < 719.01) << u << ' ' << v;
        }
}

TEST(Rectify, RefusesWhatIsNoRig)
{
    const auto refused = [](auto change) {
        StereoRig rig = rendered_rig();
        change(rig);
        const Result<Rectification> outcome = rectify(rig, kCrop, "rig.yaml");
        EXPECT_FALSE(outcome.ok());
        return std::string(outcome.status().message());
    };
    EXPECT_NE(refused([](StereoRig& m) { m.left.cx = std::nan(""); }).find("not finite"), std::string::npos);
    EXPECT_NE(refused([](StereoRig& m) { m.shift_mm = {85, 0, 0}; }).find("swapped"), std::string::npos);
    EXPECT_NE(refused([](StereoRig& m) { m.shift_mm = {1, -85, 0}; }).find("above each other"), std::string::npos);
    EXPECT_NE(refused([](StereoRig& m) { m.shift_mm = {-0.085, 0, 0}; }).find("unit: m"), std::string::npos);
    EXPECT_NE(refused([](StereoRig& m) { m.turn[0] = -1; }).find("no rotation"), std::string::npos);
    EXPECT_NE(refused([](StereoRig& m) { m.right.fy = 0; }).find("focal length"), std::string::npos);
    EXPECT_NE(refused([](StereoRig& m) { m.left.k[0] = -3; }).find("cannot be undone"), std::string::npos);
}

TEST(RemapTable, EveryPixelIsWithin1Of64OfTheDoubleMap)
{
    const StereoRig rig = rendered_rig();
    for (const double keep : {kCrop, kKeepAll}) {
        const Rectification flat = rectify(rig, keep, "rig.yaml").value();
        const LensMap map = map_of(rig.right, flat.right_rectifying, flat);
        Built built(map, 1280, 720);
        EXPECT_EQ(built.table.cell_px(), 8);
        EXPECT_LT(built.table.table_bytes(), 125'000u);
        double worst = 0;
        for (int y = 0; y < 720; ++y) {
            built.table.row_spans(y, built.spans);
            for (int x = 0; x < 1280; ++x) {
                const RemapSpan& span = built.spans[static_cast<std::size_t>(x / 8)];
                const Point2 exact = map.source_of(x, y);
                if (exact.x < 0 || exact.y < 0 || exact.x > 1279 || exact.y > 719)
                    continue;
                worst = std::max({worst, std::fabs((span.x + x % 8 * span.dx) / 65536.0 - exact.x),
                                  std::fabs((span.y + x % 8 * span.dy) / 65536.0 - exact.y)});
            }
        }
        EXPECT_LE(worst, 1.0 / 64);
        EXPECT_LE(built.table.worst_error_px(), 1.0 / 64);
        EXPECT_GE(built.table.worst_error_px(), worst - 1.0 / 256) << "the table tells less than its error";
        std::printf("keep %.0f: worst %.5f px before rounding to 1/128, %.5f after; %zu bytes\n", keep, worst,
                    built.table.worst_error_px(), built.table.table_bytes());
    }
}

TEST(RemapTable, AStrongLensGetsSmallerCellsAndAnImpossibleOneIsRefused)
{
    const Turn none{1, 0, 0, 0, 1, 0, 0, 0, 1};
    const Lens strong{250, 250, 159.5, 119.5, {-0.38, 0.15}};
    EXPECT_EQ(Built(LensMap(strong, none, 300, 159.5, 119.5), 320, 240).table.cell_px(), 4);
    const Lens impossible{60, 60, 159.5, 119.5, {3.0}};
    test::Memory memory(RemapTable::most_bytes(320, 240));
    Arena arena = memory.arena();
    const auto refused = RemapTable::build(LensMap(impossible, none, 60, 159.5, 119.5), 320, 240, arena, "rig.yaml");
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(std::string(refused.status().message()).find("1/64"), std::string::npos);
}

TEST(RemapTable, BytesAreTheSameEverywhereAndDamageIsFound)
{
    const StereoRig rig = rendered_rig();
    const Rectification flat = rectify(rig, kCrop, "rig.yaml").value();
    Built built(map_of(rig.left, flat.left_rectifying, flat), 1280, 720);
    std::vector<std::byte> bytes(built.table.serial_bytes());
    const std::uint32_t left = built.table.write(bytes);
    Built other(map_of(rig.right, flat.right_rectifying, flat), 1280, 720);
    std::vector<std::byte> right_bytes(other.table.serial_bytes());
    const std::uint32_t right = other.table.write(right_bytes);
    std::printf("checksums of the tables: left %08X, right %08X\n", left, right);
    // gcc 12 and clang 14 on x86-64, gcc 12 on aarch64 and armhf: a new value is a new format (README.md).
    EXPECT_EQ(left, 0xD40BE204u);
    EXPECT_EQ(right, 0x9BACFEE1u);
    EXPECT_EQ(crc32(std::span{bytes}.first(bytes.size() - 4)), left);
    other.arena.rewind(0);
    const Result<RemapTable> read = RemapTable::read(bytes, other.arena, "table");
    ASSERT_TRUE(read.ok()) << read.status().message();
    std::vector<std::byte> again(read.value().serial_bytes());
    read.value().write(again);
    EXPECT_EQ(bytes, again);
    EXPECT_EQ(read.value().worst_error_px(), built.table.worst_error_px());
    EXPECT_EQ(read.value().pixels_with_source(), built.table.pixels_with_source());
    std::mt19937 random{3};
    for (int i = 0; i < 40; ++i) {
        std::vector<std::byte> damaged = bytes;
        const std::size_t at = random() % damaged.size();
        damaged[at] ^= static_cast<std::byte>(1u << (random() % 8));
        other.arena.rewind(0);
        EXPECT_FALSE(RemapTable::read(damaged, other.arena, "table").ok()) << "byte " << at;
    }
    other.arena.rewind(0);
    EXPECT_FALSE(RemapTable::read(std::span{bytes}.first(bytes.size() - 1), other.arena, "table").ok());
}

TEST(Remap, GreyAndColourAgreeAndTheIdentityChangesNothing)
{
    const Turn none{1, 0, 0, 0, 1, 0, 0, 0, 1};
    const Lens plain{300, 300, 49.5, 29.5, {}};
    constexpr int kWidth = 101, kHeight = 59;
    std::mt19937 random{9};
    std::vector<Rgb8> colour(kWidth * kHeight), colour_out(colour.size());
    std::vector<std::uint8_t> grey(colour.size()), grey_out(colour.size());
    for (std::size_t i = 0; i < colour.size(); ++i) {
        grey[i] = static_cast<std::uint8_t>(random());
        colour[i] = {grey[i], grey[i], grey[i]};
    }
    const ImageView<Rgb8> from{colour.data(), kWidth, kHeight}, into{colour_out.data(), kWidth, kHeight};
    const ImageView<std::uint8_t> grey_from{grey.data(), kWidth, kHeight}, grey_into{grey_out.data(), kWidth, kHeight};

    Built identity(LensMap(plain, none, 300, 49.5, 29.5), kWidth, kHeight);
    remap(identity.table, kScalarKernels, from, into, identity.spans);
    EXPECT_TRUE(colour == colour_out);

    Built shifted(LensMap(plain, none, 290, 53.2, 20.1), kWidth, kHeight);
    remap(shifted.table, kScalarKernels, from, into, shifted.spans);
    remap(shifted.table, grey_from, grey_into, shifted.spans);
    std::vector<std::uint8_t> mask(kWidth);
    std::int64_t with_source = 0;
    for (int y = 0; y < kHeight; ++y) {
        shifted.table.row_spans(y, shifted.spans);
        shifted.table.row_mask(shifted.spans, mask);
        for (int x = 0; x < kWidth; ++x) {
            ASSERT_EQ(into.at(x, y).g, grey_into.at(x, y)) << x << ' ' << y;
            const auto range = shifted.table.row_ranges()[static_cast<std::size_t>(y)];
            const bool inside = mask[static_cast<std::size_t>(x)] != 0;
            with_source += inside ? 1 : 0;
            if (!inside) {
                ASSERT_EQ(grey_into.at(x, y), 0);
            } else {
                ASSERT_TRUE(x >= range.first && x < range.end);
            }
        }
    }
    EXPECT_EQ(with_source, shifted.table.pixels_with_source());
    EXPECT_LT(with_source, kWidth * kHeight);
}

} // namespace
} // namespace dicot
