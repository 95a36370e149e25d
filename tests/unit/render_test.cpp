#include "dicot/cloud/disparity_picture.h"
#include "dicot/cloud/render.h"

#include <gtest/gtest.h>

#include <vector>

namespace dicot {
namespace {

constexpr int kWidth = 120;
constexpr int kHeight = 90;

struct Picture
{
    std::vector<Rgb8> pixels = std::vector<Rgb8>(kWidth * kHeight);
    ImageView<Rgb8> view{pixels.data(), kWidth, kHeight};
};

/// A wall of one colour, as a camera of `focal_px` sees it, one point a pixel; z in steps.
void add_wall(std::vector<CloudPoint>& points, int half_width_px, int z, int focal_px, Rgb8 colour)
{
    for (int y = -half_width_px; y <= half_width_px; ++y)
        for (int x = -half_width_px; x <= half_width_px; ++x)
            points.push_back({x * z / focal_px, y * z / focal_px, z, colour, 255});
}

Picture rendered(const std::vector<CloudPoint>& points, double focal_px, const Viewpoint& from)
{
    Arena measure;
    lay_out_render(measure, kWidth, kHeight);
    struct alignas(Arena::kAlignment) Line
    {
        std::byte bytes[Arena::kAlignment];
    };
    std::vector<Line> memory(measure.peak() / sizeof(Line));
    Arena arena{std::as_writable_bytes(std::span{memory})};
    Picture picture;
    render_cloud({points, CloudGrid{}}, focal_px, from, picture.view, arena);
    EXPECT_FALSE(arena.overrun());
    return picture;
}

int count(const Picture& picture, auto wanted)
{
    int found = 0;
    for (const Rgb8& pixel : picture.pixels)
        found += wanted(pixel) ? 1 : 0;
    return found;
}

bool reddish(const Rgb8& pixel)
{
    return pixel.r > 100 && pixel.g < 90 && pixel.b < 90;
}
bool bluish(const Rgb8& pixel)
{
    return pixel.b > 100 && pixel.r < 90 && pixel.g < 90;
}

TEST(Render, AWallFillsThePictureWithoutGaps)
{
    std::vector<CloudPoint> points;
    add_wall(points, 60, 10000, 600, {200, 30, 30});
    const Picture picture = rendered(points, 600, {});
    for (int y = 20; y < kHeight - 20; ++y)
        for (int x = 40; x < kWidth - 40; ++x)
            ASSERT_TRUE(reddish(picture.view.at(x, y))) << x << ", " << y;
}

TEST(Render, TheNearerWallHidesTheFarther)
{
    std::vector<CloudPoint> points;
    add_wall(points, 40, 9000, 600, {200, 30, 30});
    add_wall(points, 40, 12000, 600, {30, 30, 200}); // exactly behind: seen from the camera nothing of it shows
    const Picture from_camera = rendered(points, 600, {});
    EXPECT_TRUE(reddish(from_camera.view.at(kWidth / 2, kHeight / 2)));
    EXPECT_LT(count(from_camera, bluish), count(from_camera, reddish) / 10);
}

TEST(Render, AViewerOnTheRightSeesTheFartherWallOnTheRight)
{
    std::vector<CloudPoint> points;
    add_wall(points, 40, 9000, 600, {200, 30, 30});
    add_wall(points, 40, 12000, 600, {30, 30, 200});
    const auto blue_side = [&](double yaw_deg) {
        const Picture picture = rendered(points, 600, {yaw_deg, 0});
        long sum = 0;
        int pixels = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                if (bluish(picture.view.at(x, y))) {
                    sum += x - kWidth / 2;
                    ++pixels;
                }
        EXPECT_GT(pixels, 100);
        return sum / pixels;
    };
    EXPECT_GT(blue_side(40), 5);
    EXPECT_LT(blue_side(-40), -5);
}

TEST(Render, AnEmptyCloudIsAnEmptyPicture)
{
    const Picture picture = rendered({}, 600, {});
    EXPECT_EQ(count(picture, [&](const Rgb8& pixel) { return pixel == picture.pixels[0]; }), kWidth * kHeight);
}

TEST(DisparityPicture, NearIsRedFarIsBlueMissingIsDarkGrey)
{
    std::vector<DispQ8> disparity(300);
    std::vector<std::uint8_t> confidence(300, 255);
    for (std::size_t i = 0; i < 300; ++i)
        disparity[i] = static_cast<DispQ8>(i % 3 == 0 ? 10 << 8 : i % 3 == 1 ? 90 << 8 : int{kDispMissing});
    DisparityMap map;
    map.relative = {disparity.data(), 30, 10};
    map.confidence = {confidence.data(), 30, 10};
    map.disparities = 100;
    std::vector<Rgb8> pixels(300);
    paint_disparities(map, {pixels.data(), 30, 10});
    EXPECT_GT(pixels[0].b, pixels[0].r);     // turbo's lower end
    EXPECT_GT(pixels[1].r, 2 * pixels[1].b); // and its upper one
    EXPECT_LT(pixels[2].r, 64);
    EXPECT_LT(std::abs(pixels[2].r - pixels[2].b), 10);
}

} // namespace
} // namespace dicot
