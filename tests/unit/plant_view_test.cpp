// A cloud finds back to the picture that it was made of.
#include "dicot/cloud/triangulate.h"
#include "dicot/plant/plant_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace dicot {
namespace {

struct alignas(Arena::kAlignment) Line
{
    std::byte bytes[Arena::kAlignment];
};

/// A map with waves of depth and holes, and its cloud.
class DrawnCloud
{
public:
    static constexpr RigGeometry kRig{320, 200, 620.37, 161.4, 97.8, 0, 85.2};

    /// One pixel of `keep_every` has a value.
    explicit DrawnCloud(unsigned keep_every)
        : disparity_(kPixels, kDispMissing), confidence_(kPixels, 200), colour_(kPixels),
          memory_(kPixels * sizeof(CloudPoint) / 64 + 2)
    {
        std::mt19937 random(5);
        for (std::size_t i = 0; i < kPixels; ++i)
            if (random() % keep_every == 0) {
                const std::size_t x = i % 320, y = i / 320;
                const std::size_t wave = (x / 40 + y / 25) % 2 * 20;
                disparity_[i] = static_cast<DispQ8>((wave + 5) * 256 + random() % 200);
                pixels_.push_back(i);
            }
        DisparityMap map;
        map.relative = {disparity_.data(), kRig.width, kRig.height};
        map.confidence = {confidence_.data(), kRig.width, kRig.height};
        map.min_disparity = 40;
        map.disparities = 64;
        Arena arena{std::as_writable_bytes(std::span{memory_})};
        const Triangulation how = triangulation_for(kRig, {300, 1500}, {100, 16, {-32768, -32768, 0}}).value();
        cloud = triangulate(map, {colour_.data(), kRig.width, kRig.height}, how, arena).cloud;
    }

    /// In the order of the cloud.
    int column(std::size_t point) const { return static_cast<int>(pixels_[point] % 320); }
    int row(std::size_t point) const { return static_cast<int>(pixels_[point] / 320); }

    PointCloud cloud;

private:
    static constexpr std::size_t kPixels = std::size_t{320} * 200;
    std::vector<DispQ8> disparity_;
    std::vector<std::uint8_t> confidence_;
    std::vector<Rgb8> colour_;
    std::vector<Line> memory_;
    std::vector<std::size_t> pixels_;
};

class View
{
public:
    explicit View(const PointCloud& cloud, std::size_t bytes = 1 << 22)
        : memory_(bytes / 64), arena_(std::as_writable_bytes(std::span{memory_})), of(plant_view(cloud, arena_))
    {
    }

private:
    std::vector<Line> memory_;
    Arena arena_;

public:
    Result<PlantView> of;
};

class EveryPoint : public testing::TestWithParam<unsigned>
{
};

TEST_P(EveryPoint, StandsWhereItsPixelStood)
{
    const DrawnCloud drawn(GetParam());
    const View view(drawn.cloud);
    ASSERT_TRUE(view.of.ok()) << view.of.status().message();
    const PlantView& found = view.of.value();
    EXPECT_NEAR(found.focal_px, DrawnCloud::kRig.focal_px, 0.01);
    std::size_t points = 0;
    int left = 320, top = 200;
    for (std::size_t i = 0; i < drawn.cloud.points.size(); ++i) {
        left = std::min(left, drawn.column(i));
        top = std::min(top, drawn.row(i));
    }
    EXPECT_NEAR(found.cx_px, DrawnCloud::kRig.cx_px - left, 0.02);
    EXPECT_NEAR(found.cy_px, DrawnCloud::kRig.cy_px - top, 0.02);
    for (int y = 0; y < found.point.height; ++y)
        for (int x = 0; x < found.point.width; ++x)
            if (const std::int32_t point = found.point.at(x, y); point != PlantView::kNoPoint) {
                ++points;
                EXPECT_EQ(x + left, drawn.column(static_cast<std::size_t>(point)));
                EXPECT_EQ(y + top, drawn.row(static_cast<std::size_t>(point)));
            }
    EXPECT_EQ(points, drawn.cloud.points.size());
}

INSTANTIATE_TEST_SUITE_P(Dense, EveryPoint, testing::Values(1U, 2U, 9U));

TEST(PlantView, RefusesWhatIsNoPicture)
{
    EXPECT_EQ(View(PointCloud{}).of.status().fault(), Fault::kBadData);

    DrawnCloud drawn(1);
    std::vector<CloudPoint> points(drawn.cloud.points.begin(), drawn.cloud.points.end());
    points[7].z = 0;
    EXPECT_EQ(View({points, drawn.cloud.grid}).of.status().fault(), Fault::kBadData);

    std::mt19937 random(3);
    for (CloudPoint& point : points)
        point = {static_cast<std::int32_t>(random() % 4000),
                 static_cast<std::int32_t>(random() % 4000),
                 static_cast<std::int32_t>(6000 + random() % 100),
                 {},
                 0};
    EXPECT_EQ(View({points, drawn.cloud.grid}).of.status().fault(), Fault::kBadData);
}

TEST(PlantView, OfTooFewPointsIsOneEmptyCell)
{
    const DrawnCloud drawn(1);
    for (const std::size_t apart : {drawn.cloud.points.size(), std::size_t{991}}) {
        std::vector<CloudPoint> specks;
        for (std::size_t i = 0; i < drawn.cloud.points.size(); i += apart)
            specks.push_back(drawn.cloud.points[i]);
        const View view({specks, drawn.cloud.grid});
        ASSERT_TRUE(view.of.ok()) << view.of.status().message();
        EXPECT_TRUE(view.of.value().too_few);
        EXPECT_EQ(view.of.value().point.width, 1);
        EXPECT_EQ(view.of.value().point.height, 1);
        EXPECT_EQ(view.of.value().point.at(0, 0), PlantView::kNoPoint);
    }
    EXPECT_FALSE(View(drawn.cloud).of.value().too_few);
}

TEST(PlantView, SaysThatMemoryIsShort)
{
    const DrawnCloud drawn(1);
    EXPECT_EQ(View(drawn.cloud, 64 << 10).of.status().fault(), Fault::kConfig);
    EXPECT_EQ(View(drawn.cloud, 64).of.status().fault(), Fault::kConfig);
}

} // namespace
} // namespace dicot
