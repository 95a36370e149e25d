// How true the clouds of rendered plants are, beside OpenCV's SGBM. Every pair is matched once for all tests.
#include "calibration_data.h"
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
    EXPECT_LE(mean.off_valued, 2.5);
    EXPECT_LT(mean.median_mm, peer.median_mm);
    EXPECT_GT(mean.valued, peer.valued);
    EXPECT_GT(mean.within_all, peer.within_all);
    EXPECT_GT(mean.within_valued, peer.within_valued);
    EXPECT_LT(mean.off_all, peer.off_all);
    EXPECT_LT(mean.off_valued, peer.off_valued);
}

struct Agreement
{
    double median_mm = 0, first_valued = 0, second_valued = 0;
};

/// Of the leaf pixels that both have a value for.
Agreement agreement_of(const RawDepth& first, const RawDepth& second, const TrueDepth& truth)
{
    std::vector<float> apart;
    long leaf = 0, in_first = 0, in_second = 0;
    for (std::size_t i = 0; i < truth.pixels(); ++i) {
        if (!truth.leaf[i])
            continue;
        ++leaf;
        in_first += !std::isnan(first.mm[i]);
        in_second += !std::isnan(second.mm[i]);
        if (const float difference = std::fabs(first.mm[i] - second.mm[i]); !std::isnan(difference))
            apart.push_back(difference);
    }
    const auto middle = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2);
    std::ranges::nth_element(apart, middle);
    const auto percent = [&](long count) { return 100 * static_cast<double>(count) / static_cast<double>(leaf); };
    return {static_cast<double>(*middle), percent(in_first), percent(in_second)};
}

TEST(PlantMeans, SunAndCloudsGiveTheSameLeaves)
{
    if (!plants_there())
        return;
    std::printf("overcast against sunny, leaf pixels: median difference, share with a value in each\n");
    double mean_mm = 0, mean_overcast = 0, mean_sunny = 0;
    for (std::size_t plant = 0; plant < kPlants.size(); ++plant) {
        const PlantPair &overcast = plant_pair(plant, 0), &sunny = plant_pair(plant, 1);
        const Agreement ours = agreement_of(overcast.ours, sunny.ours, plant_truth(plant));
        const Agreement peer = agreement_of(overcast.peer, sunny.peer, plant_truth(plant));
        std::printf("  %-14s ours %.2f mm, %.2f and %.2f %%; SGBM %.2f mm, %.2f and %.2f %%\n", kPlants[plant],
                    ours.median_mm, ours.first_valued, ours.second_valued, peer.median_mm, peer.first_valued,
                    peer.second_valued);
        mean_mm += ours.median_mm / double(kPlants.size());
        mean_overcast += ours.first_valued / double(kPlants.size());
        mean_sunny += ours.second_valued / double(kPlants.size());
        EXPECT_LE(ours.median_mm, 1.0) << kPlants[plant];
        EXPECT_LE(std::fabs(ours.first_valued - ours.second_valued), 2.0) << kPlants[plant];
    }
    std::printf("  %-14s ours %.2f mm, %.2f and %.2f %%\n", "mean", mean_mm, mean_overcast, mean_sunny);
}

/// Bright light has taken one channel at least to the end of its scale.
bool saturated(Rgb8 pixel)
{
    constexpr int kEnd = 250;
    return std::max({pixel.r, pixel.g, pixel.b}) >= kEnd;
}

/// Of the marked pixels, those with an error below 5 mm; a pixel without a value counts against it.
double share_within_5mm(const RawDepth& depth, const TrueDepth& truth, const std::vector<bool>& marked)
{
    constexpr float kLimitMm = 5;
    long all = 0, good = 0;
    for (std::size_t i = 0; i < truth.pixels(); ++i)
        if (marked[i]) {
            ++all;
            good += std::fabs(depth.mm[i] - truth.mm[i]) < kLimitMm;
        }
    return 100 * static_cast<double>(good) / static_cast<double>(all);
}

TEST(PlantMeans, HighlightsOfLeavesKeepTheirPlace)
{
    if (!plants_there())
        return;
    constexpr long kEnough = 50;
    std::printf("leaf pixels in sun with a channel at 250 or more: share with an error below 5 mm\n");
    for (std::size_t plant = 0; plant < kPlants.size(); ++plant) {
        const PlantPair& pair = plant_pair(plant, 1);
        const TrueDepth& truth = plant_truth(plant);
        std::vector<bool> marked(truth.pixels());
        for (std::size_t i = 0; i < truth.pixels(); ++i)
            marked[i] = truth.leaf[i] && saturated(pair.left.pixels[i]);
        const long count = std::ranges::count(marked, true);
        if (count < kEnough)
            continue;
        const double ours = share_within_5mm(pair.ours, truth, marked);
        std::printf("  %-14s %ld px: ours %.1f %%, SGBM %.1f %%\n", kPlants[plant], count, ours,
                    share_within_5mm(pair.peer, truth, marked));
        EXPECT_GE(ours, 90) << kPlants[plant];
    }
}

class Plants : public testing::TestWithParam<std::size_t>
{
};

TEST_P(Plants, NoSpeciesIsLeftBehind)
{
    if (!plants_there())
        return;
    for (std::size_t light = 0; light < kLights.size(); ++light) {
        const PlantPair& pair = plant_pair(GetParam(), light);
        const DepthFigures figures = leaf_figures(GetParam(), pair.ours);
        EXPECT_GT(figures.pixels, 10000) << pair.name;
        EXPECT_LE(figures.median_mm, 1.5) << pair.name;
        EXPECT_GE(figures.valued, 88) << pair.name;
        EXPECT_GE(figures.within_valued, 75) << pair.name;
        EXPECT_LE(figures.off_valued, 6) << pair.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Each, Plants, testing::Range(std::size_t{0}, kPlants.size()),
                         [](const auto& plant) { return std::string(kPlants[plant.param]); });

} // namespace
} // namespace dicot::test
