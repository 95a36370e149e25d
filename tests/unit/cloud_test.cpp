#include "cloud_cases.h"

#include "dicot/cloud/triangulate.h"
#include "dicot/cloud/working_range.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>
#include <vector>

namespace dicot {
namespace {

/// A disparity map with its picture and the memory for its cloud.
struct Scene
{
    Scene(int w, int h, int min_disparity_px)
        : width(w), height(h), disparity(static_cast<std::size_t>(w * h), kDispMissing),
          confidence(disparity.size(), 128), colour(disparity.size()),
          memory(disparity.size() * sizeof(CloudPoint) / 64 + 2)
    {
        map.relative = {disparity.data(), w, h};
        map.confidence = {confidence.data(), w, h};
        map.min_disparity = min_disparity_px;
        map.disparities = kMaxDisparities;
    }
    Triangulated triangulated(const Triangulation& how)
    {
        Arena arena{std::as_writable_bytes(std::span{memory})};
        return triangulate(map, {colour.data(), width, height}, how, arena);
    }

    struct alignas(Arena::kAlignment) Line
    {
        std::byte bytes[Arena::kAlignment];
    };
    int width, height;
    std::vector<DispQ8> disparity;
    std::vector<std::uint8_t> confidence;
    std::vector<Rgb8> colour;
    std::vector<Line> memory;
    DisparityMap map;
};

CloudGrid wide_grid()
{
    return {100, 20, {-(1 << 19), -(1 << 19), 0}};
}

/// Equations 16 to 18 as they stand in the paper, with principal points and offset, in grid steps.
struct Exact
{
    long double x, y, z;
};
Exact exact_point(const RigGeometry& rig, const CloudGrid& grid, int x, int y, long double disparity_px)
{
    const long double d = disparity_px + static_cast<long double>(rig.disparity_offset_px);
    const long double z_mm = static_cast<long double>(rig.focal_px) * static_cast<long double>(rig.baseline_mm) / d;
    const long double steps_per_mm = 1000.0L / grid.step_um;
    const long double f = static_cast<long double>(rig.focal_px);
    return {(x - static_cast<long double>(rig.cx_px)) * z_mm / f * steps_per_mm,
            (y - static_cast<long double>(rig.cy_px)) * z_mm / f * steps_per_mm, z_mm * steps_per_mm};
}

TEST(Triangulate, AgreesWithTheEquationsToTheNearestStep)
{
    const std::uint32_t seed = 20240518;
    std::mt19937 random{seed};
    const auto between = [&](double low, double high) {
        return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    std::int64_t compared = 0;
    for (int round = 0; round < 60; ++round) {
        const RigGeometry rig{
            200, 60, between(150, 4000), between(-50, 250), between(-20, 80), between(-20, 300), between(10, 400)};
        const WorkingRange range{between(50, 300), between(2000, 20000)};
        Scene scene{rig.width, rig.height, static_cast<int>(random() % 40)};
        for (DispQ8& d : scene.disparity)
            d = static_cast<DispQ8>(random() % (255 * 256));
        const Triangulation how = triangulation_for(rig, range, wide_grid()).value();
        for (std::size_t i = 0; i < scene.colour.size(); ++i) // the colour tells which pixel a point came from
            scene.colour[i] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8), 0};
        const Triangulated result = scene.triangulated(how);
        std::vector<const CloudPoint*> point_of(scene.colour.size(), nullptr);
        for (const CloudPoint& point : result.cloud.points)
            point_of[static_cast<std::size_t>(point.colour.r + 256 * point.colour.g)] = &point;
        for (std::size_t i = 0; i < point_of.size(); ++i) {
            const double d = scene.map.min_disparity + scene.disparity[i] / 256.0;
            const Exact exact = exact_point(rig, how.grid, static_cast<int>(i) % rig.width,
                                            static_cast<int>(i) / rig.width, static_cast<long double>(d));
            const auto margin = [](long double value, auto least, auto most) {
                return std::min(value - static_cast<long double>(least), static_cast<long double>(most) - value);
            };
            const long double inside =
                std::min({margin(exact.z, how.near_steps, how.far_steps), margin(exact.x, -(1 << 19), (1 << 19) - 1),
                          margin(exact.y, -(1 << 19), (1 << 19) - 1)});
            if (point_of[i] == nullptr) {
                ASSERT_TRUE(inside < 1 || d + rig.disparity_offset_px <= 0)
                    << "seed " << seed << " round " << round << " pixel " << i;
                continue;
            }
            ASSERT_GT(inside, -1) << "seed " << seed << " round " << round << " pixel " << i;
            const auto off = [](long double meant, std::int32_t got) {
                return std::fabs(meant - static_cast<long double>(got));
            };
            ASSERT_LE(off(exact.z, point_of[i]->z), 0.5625L) << "seed " << seed << " round " << round << " pixel " << i;
            ASSERT_LE(off(exact.x, point_of[i]->x), 0.5625L) << "seed " << seed << " round " << round << " pixel " << i;
            ASSERT_LE(off(exact.y, point_of[i]->y), 0.5625L) << "seed " << seed << " round " << round << " pixel " << i;
            ++compared;
        }
        const PixelCount& pixels = result.pixels;
        EXPECT_EQ(pixels.points + pixels.missing + pixels.beyond + pixels.too_near + pixels.too_far +
                      pixels.outside_grid,
                  rig.width * rig.height);
    }
    EXPECT_GT(compared, 100000);
}

TEST(Triangulate, WorkedExample)
{
    // f = 1000 px, B = 100 mm, d = 100 px: Z = 1 m; 50 px right of the centre are 50 mm, 25 px above it -25 mm.
    const RigGeometry rig{200, 100, 1000, 100, 50, 0, 100};
    Scene scene{200, 100, 0};
    scene.disparity[25 * 200 + 150] = 100 << kDispFractionBits;
    scene.colour[25 * 200 + 150] = {1, 2, 3};
    scene.confidence[25 * 200 + 150] = 77;
    const Triangulated result = scene.triangulated(triangulation_for(rig, {500, 2000}, wide_grid()).value());
    ASSERT_EQ(result.cloud.points.size(), 1U);
    const CloudPoint& point = result.cloud.points[0];
    EXPECT_EQ(point.x, 500);
    EXPECT_EQ(point.y, -250);
    EXPECT_EQ(point.z, 10000);
    EXPECT_EQ(point.colour, (Rgb8{1, 2, 3}));
    EXPECT_EQ(point.confidence, 77);
    EXPECT_EQ(result.pixels.missing, 200 * 100 - 1);
}

TEST(Triangulate, HalfStepsRoundAwayFromZero)
{
    // b = 1000 steps, d = 2000 px: each pixel beside the centre is half a step.
    const RigGeometry rig{3, 3, 4000, 1, 1, 2000, 100};
    Scene scene{3, 3, 0};
    for (DispQ8& d : scene.disparity)
        d = 0;
    const Triangulated result = scene.triangulated(triangulation_for(rig, {100, 300}, wide_grid()).value());
    ASSERT_EQ(result.cloud.points.size(), 9U);
    EXPECT_EQ(result.cloud.points[0].x, -1);
    EXPECT_EQ(result.cloud.points[0].y, -1);
    EXPECT_EQ(result.cloud.points[4].x, 0);
    EXPECT_EQ(result.cloud.points[8].x, 1);
    EXPECT_EQ(result.cloud.points[8].y, 1);
}

TEST(Triangulate, WorkingRangeIsInclusive)
{
    // f B = 100000 px mm: d = 100 px is 1000 mm, 200 px is 500 mm.
    const RigGeometry rig{5, 1, 1000, 2, 0, 0, 100};
    Scene scene{5, 1, 0};
    scene.disparity = {100 << 8, 200 << 8, (100 << 8) - 4, (200 << 8) + 16, 150 << 8};
    const Triangulated result = scene.triangulated(triangulation_for(rig, {500, 1000}, wide_grid()).value());
    EXPECT_EQ(result.pixels.points, 3);
    EXPECT_EQ(result.pixels.too_far, 1);
    EXPECT_EQ(result.pixels.too_near, 1);
}

TEST(Triangulate, DropsWhatLiesAtInfinityOrOutsideTheGrid)
{
    const RigGeometry rig{3, 1, 1000, 1, 0, -10, 100};
    Scene scene{3, 1, 0};
    scene.disparity = {5 << 8, 10 << 8, 110 << 8}; // d - 10: -5, 0 and 100 px
    const WorkingRange range{500, 2000};
    Triangulated result = scene.triangulated(triangulation_for(rig, range, wide_grid()).value());
    EXPECT_EQ(result.pixels.beyond, 2);
    EXPECT_EQ(result.pixels.points, 1);
    const CloudGrid small{100, 14, {0, 0, 0}}; // z up to 1638.3 mm; x = 1 px * 1 m / f = 10 steps
    result = scene.triangulated(triangulation_for(rig, range, small).value());
    EXPECT_EQ(result.pixels.points, 1);
    const CloudGrid aside{100, 14, {11, 0, 0}};
    result = scene.triangulated(triangulation_for(rig, range, aside).value());
    EXPECT_EQ(result.pixels.outside_grid, 1);
}

TEST(Triangulate, LargestRigAndPictureCornerStayInside64Bits)
{
    // Every bound of working_range.h at once; the sanitizer build watches the arithmetic.
    RigGeometry rig{2, 2, kMaxFocalPx, kMaxPrincipalPointPx, -kMaxPrincipalPointPx, kMaxPrincipalPointPx, 26214.4};
    Scene scene{2, 2, 16000};
    scene.disparity = {0, 255 * 256 - 1, 1, 2};
    Triangulation how = triangulation_for(rig, {1, 1e6}, wide_grid()).value();
    how.grid.bits = 24;
    const Triangulated result = scene.triangulated(how);
    EXPECT_EQ(result.pixels.points + result.pixels.outside_grid, 4);
    const Exact exact = exact_point(rig, how.grid, 0, 0, 16000.0L);
    ASSERT_FALSE(result.cloud.points.empty());
    EXPECT_LE(std::fabs(exact.z - static_cast<long double>(result.cloud.points[0].z)), 0.5625L);
}

TEST(Triangulate, MeasuringArenaAsksForEveryPixel)
{
    Scene scene{40, 30, 0};
    Arena measure;
    const auto how = triangulation_for(test::aloe_third(), {1000, 2000}, wide_grid()).value();
    const Triangulated nothing = triangulate(scene.map, {scene.colour.data(), 40, 30}, how, measure);
    EXPECT_TRUE(nothing.cloud.points.empty());
    EXPECT_EQ(measure.peak(), 40U * 30U * sizeof(CloudPoint));
}

TEST(WorkingRange, DisparitiesCoverTheRangeAndNoMore)
{
    const RigGeometry rig = test::aloe_third(); // f B = 199466.67 px mm
    const DisparityRange range = disparity_range(rig, {1200, 2000}).value();
    // 199466.67 / 2000 - 90 = 9.7 and 199466.67 / 1200 - 90 = 76.2
    EXPECT_EQ(range.min_disparity, 9);
    EXPECT_EQ(range.disparities, 77 - 9 + 1);
}

TEST(WorkingRange, TooWideASearchNamesTheNearestDistanceThatWorks)
{
    const RigGeometry rig{1280, 720, 800, 640, 360, 0, 120};
    const Result<DisparityRange> refused = disparity_range(rig, {200, 2000});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.status().fault(), Fault::kUsage);
    const char* remedy = std::strstr(refused.status().message(), "--near-mm ");
    ASSERT_NE(remedy, nullptr);
    const double near_mm = std::strtod(remedy + std::strlen("--near-mm "), nullptr);
    EXPECT_TRUE(disparity_range(rig, {near_mm, 2000}).ok()) << refused.status().message();
    EXPECT_FALSE(disparity_range(rig, {near_mm - 5, 2000}).ok()) << refused.status().message();
}

TEST(WorkingRange, SenselessRangesAreRefused)
{
    const RigGeometry rig = test::aloe_third();
    for (const WorkingRange range :
         {WorkingRange{0, 1000}, {-5, 1000}, {1000, 1000}, {2000, 1000}, {NAN, 1000}, {100, INFINITY}}) {
        EXPECT_EQ(disparity_range(rig, range).status().fault(), Fault::kUsage) << range.near_mm << " " << range.far_mm;
        EXPECT_EQ(grid_for(rig, range).status().fault(), Fault::kUsage);
        EXPECT_EQ(triangulation_for(rig, range, CloudGrid{}).status().fault(), Fault::kUsage);
    }
}

TEST(WorkingRange, DisparityWiderThanThePictureIsRefused)
{
    const RigGeometry rig{64, 48, 800, 32, 24, 0, 60};
    EXPECT_EQ(disparity_range(rig, {500, 2000}).status().fault(), Fault::kUsage);
}

TEST(WorkingRange, SenselessRigsAreRefused)
{
    const RigGeometry good = test::aloe_third();
    EXPECT_TRUE(check_rig(good).ok());
    const auto refused = [&good](auto spoil) {
        RigGeometry rig = good;
        spoil(rig);
        return !check_rig(rig).ok();
    };
    EXPECT_TRUE(refused([](RigGeometry& rig) { rig.focal_px = 0; }));
    EXPECT_TRUE(refused([](RigGeometry& rig) { rig.focal_px = NAN; }));
    EXPECT_TRUE(refused([](RigGeometry& rig) { rig.baseline_mm = -160; }));
    EXPECT_TRUE(refused([](RigGeometry& rig) { rig.baseline_mm = 1e9; }));
    EXPECT_TRUE(refused([](RigGeometry& rig) { rig.cx_px = INFINITY; }));
    EXPECT_TRUE(refused([](RigGeometry& rig) { rig.width = 0; }));
}

TEST(Grid, HoldsTheCornersOfTheFrustumAtBothEnds)
{
    for (const auto& [rig, range] :
         {std::pair{test::aloe_third(), WorkingRange{1000, 2500}},
          std::pair{RigGeometry{1280, 720, 780, 640, 360, 0, 85}, WorkingRange{300, 1200}},
          std::pair{RigGeometry{640, 480, 600, 900, -200, 0, 60}, WorkingRange{200, 6000}}}) {
        const CloudGrid grid = grid_for(rig, range).value();
        for (const double z_mm : {range.near_mm, range.far_mm})
            for (const int x : {0, rig.width - 1})
                for (const int y : {0, rig.height - 1}) {
                    const double steps[3] = {(x - rig.cx_px) * z_mm / rig.focal_px * 10,
                                             (y - rig.cy_px) * z_mm / rig.focal_px * 10, z_mm * 10};
                    for (int axis = 0; axis < 3; ++axis) {
                        EXPECT_GE(std::round(steps[axis]) - grid.origin[axis], 0);
                        EXPECT_LE(std::round(steps[axis]) - grid.origin[axis], (1 << grid.bits) - 1);
                    }
                }
    }
}

TEST(Grid, Is14BitsOfATenthOfAMillimetreWhereThatIsEnough)
{
    const RigGeometry rig{1280, 720, 1200, 640, 360, 0, 85}; // sees 1.28 m across at 1.2 m
    EXPECT_EQ(grid_for(rig, {300, 1200}).value().bits, 14);
    EXPECT_EQ(grid_for(rig, {300, 1200}).value().step_um, 100);
    EXPECT_EQ(grid_for(rig, {300, 1700}).value().bits, 15); // 1.81 m across
    EXPECT_FALSE(grid_for(rig, {300, 200000}).ok());
}

} // namespace
} // namespace dicot
