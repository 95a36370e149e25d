// How true the clouds of rendered plants are, beside OpenCV's SGBM. Every pair is matched once for all tests.
#include "calibration_data.h"
#include "own_rig.h"
#include "plant_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace dicot::test {
namespace {

bool plants_there()
{
    return data_there("rig-dev/plants");
}

/// What a perfect matcher would measure: the true points, seen by the true cameras, through the rig `known`.
RawDepth perfectly_matched(const TrueDepth& truth, const StereoRig& cameras, const StereoRig& known)
{
    const Rectification flat = rectify(known, kCrop, "the rig").value();
    const Turn back = transposed(flat.left_rectifying);
    const auto flat_direction = [](const Lens& lens, const Turn& turn, const Point2& pixel) {
        const Point2 seen = undistort(lens, pixel).value();
        const Point3 p = turned(turn, {seen.x, seen.y, 1});
        return Point2{p.x / p.z, p.y / p.z};
    };
    RawDepth depth{std::vector<float>(truth.pixels(), NAN), {}};
    for (std::size_t i = 0; i < truth.pixels(); ++i) {
        if (!truth.leaf[i])
            continue;
        const auto width = static_cast<std::size_t>(truth.width);
        const Point2 pixel{static_cast<double>(i % width), static_cast<double>(i / width)};
        const Point2 ray = undistort(cameras.left, pixel).value();
        const auto z_mm = static_cast<double>(truth.mm[i]);
        const Point2 in_right = project(cameras.right, cameras.into_right({ray.x * z_mm, ray.y * z_mm, z_mm}));
        const Point2 left = flat_direction(known.left, flat.left_rectifying, pixel);
        const double z = flat.baseline_mm / (left.x - flat_direction(known.right, flat.right_rectifying, in_right).x);
        depth.mm[i] = static_cast<float>(turned(back, {left.x * z, left.y * z, z}).z);
    }
    return depth;
}

TEST(PlantMeans, OwnCalibrationAloneCostsATenthOfAMillimetre)
{
    if (!plants_there())
        return;
    for (std::size_t plant = 0; plant < kPlants.size(); ++plant) {
        const StereoRig cameras = rig_dev_truth();
        const DepthFigures exact = leaf_figures(plant, perfectly_matched(plant_truth(plant), cameras, cameras));
        const DepthFigures own = leaf_figures(plant, perfectly_matched(plant_truth(plant), cameras, own_rig()));
        std::printf("perfect matches of %s: median error %.4f mm with the true calibration, %.3f mm with our own\n",
                    kPlants[plant], exact.median_mm, own.median_mm);
        EXPECT_LE(exact.median_mm, 0.001);
        EXPECT_LE(own.median_mm, 0.1);
    }
}

TEST(PlantMeans, LeavesStandWhereTheyAre)
{
    if (!plants_there())
        return;
    std::vector<DepthFigures> ours, peers;
    for (std::size_t plant = 0; plant < kPlants.size(); ++plant)
        for (std::size_t light = 0; light < kLights.size(); ++light) {
            ours.push_back(leaf_figures(plant, plant_pair(plant, light).ours));
            peers.push_back(leaf_figures(plant, plant_pair(plant, light).peer));
        }
    const DepthFigures mean = mean_of(ours), peer = mean_of(peers);
    print_row("MEAN OF THE TWELVE", "ours", mean);
    print_row("", "SGBM", peer);
    EXPECT_LE(mean.median_mm, 0.8);
    EXPECT_GE(mean.valued, 93);
    EXPECT_GE(mean.within_valued, 88);
    EXPECT_LE(mean.off_valued, 2.7); // aimed at: 2.5
    EXPECT_LT(mean.median_mm, peer.median_mm);
    EXPECT_GT(mean.valued, peer.valued);
    EXPECT_GT(mean.within_all, peer.within_all);
    EXPECT_GT(mean.within_valued, peer.within_valued);
    EXPECT_LT(mean.off_all, peer.off_all);
    EXPECT_LT(mean.off_valued, peer.off_valued);
}

/// Of leaf pixels in two lights.
struct Agreement
{
    long leaf = 0, in_overcast = 0, in_sunny = 0;
    std::vector<float> apart_mm; ///< of those that have a value in both

    void add(const RawDepth& overcast, const RawDepth& sunny, const TrueDepth& truth)
    {
        for (std::size_t i = 0; i < truth.pixels(); ++i) {
            if (!truth.leaf[i])
                continue;
            ++leaf;
            in_overcast += !std::isnan(overcast.mm[i]);
            in_sunny += !std::isnan(sunny.mm[i]);
            if (const float apart = std::fabs(overcast.mm[i] - sunny.mm[i]); !std::isnan(apart))
                apart_mm.push_back(apart);
        }
    }
    double median_mm()
    {
        const auto middle = apart_mm.begin() + static_cast<std::ptrdiff_t>(apart_mm.size() / 2);
        std::ranges::nth_element(apart_mm, middle);
        return static_cast<double>(*middle);
    }
    double percent(long count) const { return 100 * static_cast<double>(count) / static_cast<double>(leaf); }
    double density_gap() const { return std::fabs(percent(in_overcast) - percent(in_sunny)); }
    void print(const char* who)
    {
        std::printf("  %s %.2f mm, %.2f and %.2f %%", who, median_mm(), percent(in_overcast), percent(in_sunny));
    }
};

TEST(PlantMeans, SunAndCloudsGiveTheSameLeaves)
{
    if (!plants_there())
        return;
    std::printf("overcast against sunny, leaf pixels: median difference where both have a value, share with one\n");
    Agreement all, peers_all;
    for (std::size_t plant = 0; plant < kPlants.size(); ++plant) {
        const PlantPair &overcast = plant_pair(plant, 0), &sunny = plant_pair(plant, 1);
        Agreement ours, peers;
        for (Agreement* to : {&ours, &all})
            to->add(overcast.ours, sunny.ours, plant_truth(plant));
        for (Agreement* to : {&peers, &peers_all})
            to->add(overcast.peer, sunny.peer, plant_truth(plant));
        std::printf("  %-14s", kPlants[plant]);
        ours.print("ours");
        peers.print("; SGBM");
        std::printf("\n");
    }
    std::printf("  %-14s", "all");
    all.print("ours");
    peers_all.print("; SGBM");
    std::printf("\n");
    EXPECT_LE(all.median_mm(), 1.0);
    EXPECT_LE(all.density_gap(), 2);
}

/// Bright light has taken one channel at least to the end of its scale.
bool saturated(Rgb8 pixel)
{
    constexpr int kEnd = 250;
    return std::max({pixel.r, pixel.g, pixel.b}) >= kEnd;
}

/// Of the marked pixels, those with an error below 5 mm.
struct Kept
{
    long marked = 0, valued = 0, good = 0;

    Kept(const RawDepth& depth, const TrueDepth& truth, const std::vector<bool>& marks)
    {
        constexpr float kLimitMm = 5;
        for (std::size_t i = 0; i < truth.pixels(); ++i)
            if (marks[i]) {
                ++marked;
                valued += !std::isnan(depth.mm[i]);
                good += std::fabs(depth.mm[i] - truth.mm[i]) < kLimitMm;
            }
    }
    double of_all() const { return 100 * static_cast<double>(good) / static_cast<double>(marked); }
    double of_valued() const { return 100 * static_cast<double>(good) / static_cast<double>(std::max(1L, valued)); }
};

TEST(PlantMeans, HighlightsOfLeavesKeepTheirPlace)
{
    if (!plants_there())
        return;
    constexpr long kEnough = 50;
    std::printf(
        "leaf pixels in sun with a channel at 250 or more: share with an error below 5 mm, and of the valued\n");
    for (std::size_t plant = 0; plant < kPlants.size(); ++plant) {
        const PlantPair& pair = plant_pair(plant, 1);
        const TrueDepth& truth = plant_truth(plant);
        std::vector<bool> marks(truth.pixels());
        for (std::size_t i = 0; i < truth.pixels(); ++i)
            marks[i] = truth.leaf[i] && saturated(pair.left.pixels[i]);
        const Kept ours(pair.ours, truth, marks), peer(pair.peer, truth, marks);
        if (ours.marked < kEnough)
            continue;
        std::printf("  %-14s %ld px: ours %.1f %%, %.1f %% of %ld; SGBM %.1f %%, %.1f %% of %ld\n", kPlants[plant],
                    ours.marked, ours.of_all(), ours.of_valued(), ours.valued, peer.of_all(), peer.of_valued(),
                    peer.valued);
        EXPECT_GE(ours.of_all(), 90) << kPlants[plant];
    }
}

class Plants : public testing::TestWithParam<std::size_t>
{
};

TEST_P(Plants, StandTruerThanThePeerSeesThem)
{
    if (!plants_there())
        return;
    for (std::size_t light = 0; light < kLights.size(); ++light) {
        const PlantPair& pair = plant_pair(GetParam(), light);
        const DepthFigures ours = leaf_figures(GetParam(), pair.ours), peer = leaf_figures(GetParam(), pair.peer);
        EXPECT_GT(ours.pixels, 10000) << pair.name;
        EXPECT_LE(ours.median_mm, peer.median_mm) << pair.name;
        EXPECT_GE(ours.within_all, peer.within_all) << pair.name;
        EXPECT_LE(ours.off_valued, peer.off_valued) << pair.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Each, Plants, testing::Range(std::size_t{0}, kPlants.size()),
                         [](const auto& plant) { return std::string(kPlants[plant.param]); });

} // namespace
} // namespace dicot::test
