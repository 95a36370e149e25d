// Whether the clouds of rendered plants know what they do not know.
#include "calibration_data.h"
#include "plant_pairs.h"
#include "sparsification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace dicot::test {
namespace {

TEST(Sparsification, AreasOfAFewPixelsAreThoseWorkedOutByHand)
{
    // Kept: the first, then both: means 0 and 1/2.
    EXPECT_DOUBLE_EQ(sparsified({{1, 10}, {0, 200}}).area, 0.25);
    EXPECT_DOUBLE_EQ(sparsified({{1, 10}, {0, 200}}).ratio(), 1);
    // The wrong one is kept: 1, 1/2.
    EXPECT_DOUBLE_EQ(sparsified({{1, 200}, {0, 10}}).area, 0.75);
    // They leave together: 1/2, 1/2.
    EXPECT_DOUBLE_EQ(sparsified({{1, 7}, {0, 7}}).area, 0.5);
    EXPECT_DOUBLE_EQ(sparsified({{1, 7}, {0, 7}}).ratio(), 2);
    // Ideal of 0, 2, 4: 0, 1, 2.
    EXPECT_DOUBLE_EQ(sparsified({{4, 1}, {0, 2}, {2, 3}}).ideal, 1);
}

bool is_leaf(const TrueDepth& truth, std::size_t i)
{
    return truth.leaf[i];
}

bool within_range(float mm)
{
    return mm >= float{kWorkingRange.near_mm} && mm <= float{kWorkingRange.far_mm};
}

enum class Measure
{
    kOff,   ///< 1 beyond 3 mm
    kSize,  ///< mm
    kCapped ///< mm, 10 at most: what is wrong is wrong
};

/// Of the pixels that `counts` chooses, those with a value.
template <typename Counts>
std::vector<Judged> judged(Measure measure, const Counts& counts)
{
    std::vector<Judged> all;
    for (std::size_t plant = 0; plant < kPlants.size(); ++plant)
        for (std::size_t light = 0; light < kLights.size(); ++light) {
            const TrueDepth& truth = plant_truth(plant);
            const RawDepth& depth = plant_pair(plant, light).ours;
            for (std::size_t i = 0; i < truth.pixels(); ++i) {
                if (std::isnan(depth.mm[i]) || !counts(truth, i))
                    continue;
                const float size = std::fabs(depth.mm[i] - truth.mm[i]);
                const float off = size > float{DepthFigures::kWithinMm} ? 1.0F : 0.0F;
                all.push_back({measure == Measure::kOff    ? off
                               : measure == Measure::kSize ? size
                                                           : std::min(size, float{DepthFigures::kOffMm}),
                               depth.confidence[i]});
            }
        }
    return all;
}

Sparsification print_sparsified(const char* name, std::vector<Judged> pixels)
{
    const std::size_t count = pixels.size();
    const Sparsification s = sparsified(std::move(pixels));
    std::printf("%s, %zu px: area %.4f, ideal %.4f: %.2f times; blind removal %.4f\n  ours ", name, count, s.area,
                s.ideal, s.ratio(), s.blind);
    for (const double point : s.curve)
        std::printf(" %7.4f", point);
    std::printf("\n  ideal");
    for (const double point : s.ideal_curve)
        std::printf(" %7.4f", point);
    std::printf("\n");
    return s;
}

TEST(PlantHonesty, TheLeastCertainAreTheMostWrong)
{
    if (!data_there("rig-dev/plants"))
        return;
    const auto surface = [](const TrueDepth& truth, std::size_t i) {
        return truth.seen_by_both[i] && within_range(truth.mm[i]);
    };
    std::printf("sparsification, the twelve together, 0, 10 .. 90 %% removed\n");
    print_sparsified("leaves, share off > 3 mm", judged(Measure::kOff, is_leaf));
    print_sparsified("leaves, mean error, mm", judged(Measure::kSize, is_leaf));
    const Sparsification capped = print_sparsified("leaves, mean error up to 10 mm", judged(Measure::kCapped, is_leaf));
    print_sparsified("all surfaces, share off > 3 mm", judged(Measure::kOff, surface));
    print_sparsified("all surfaces, mean error up to 10 mm", judged(Measure::kCapped, surface));
    // Aimed at: 1.5. One that knew the true error of the 9 x 9 neighbours would reach 1.31 by this measure and 1.5 by
    // the other two, so the error is capped.
    EXPECT_LE(capped.ratio(), 1.7);
}

/// The confidence that nine of ten leaf pixels within 3 mm reach.
int confidence_of_leaves()
{
    std::array<long, 256> counts{};
    long all = 0;
    for (const Judged& pixel : judged(Measure::kOff, is_leaf))
        if (pixel.wrong == 0) {
            ++counts[pixel.confidence];
            ++all;
        }
    int level = 0;
    for (long below = counts[0]; below * 10 < all; below += counts[static_cast<std::size_t>(level)])
        ++level;
    return level;
}

/// Where nobody can match, and what the matchers said of it.
struct Place
{
    const char* name;
    long pixels = 0;
    long ours = 0, peers = 0;                 ///< with a value
    long ours_guessed = 0, peers_guessed = 0; ///< with a value more than 10 mm off
    long ours_sure = 0;                       ///< of ours_guessed: as confident as leaves are

    void add(const PlantPair& pair, const TrueDepth& truth, std::size_t i, int sure)
    {
        const auto guessed = [&](const RawDepth& depth) {
            return std::fabs(depth.mm[i] - truth.mm[i]) > float{DepthFigures::kOffMm};
        };
        ++pixels;
        ours += !std::isnan(pair.ours.mm[i]);
        peers += !std::isnan(pair.peer.mm[i]);
        ours_guessed += guessed(pair.ours);
        peers_guessed += guessed(pair.peer);
        ours_sure += guessed(pair.ours) && pair.ours.confidence[i] >= sure;
    }
    double percent(long part) const { return 100 * double(part) / double(std::max(1L, pixels)); }
};

/// Marks pixels around which the brightness, smoothed, hardly changes along the row.
std::vector<bool> blank_places(const scenes::Picture& picture)
{
    constexpr int kReach = 10, kStep = 2, kFaint = 4 * 9 * 3; // 4 levels, times 3 x 3 px and 3 channels
    const int width = picture.width, height = picture.height;
    const auto at = [&](int x, int y) { return static_cast<std::size_t>(y * width + x); };
    std::vector<int> smooth(picture.pixels.size()), change(picture.pixels.size(), kFaint + 1);
    for (int y = 1; y < height - 1; ++y)
        for (int x = 1; x < width - 1; ++x)
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) {
                    const Rgb8 p = picture.pixels[at(x + i, y + j)];
                    smooth[at(x, y)] += p.r + p.g + p.b;
                }
    for (int y = 1; y < height - 1; ++y)
        for (int x = kStep + 1; x < width - kStep - 1; ++x)
            change[at(x, y)] = std::abs(smooth[at(x + kStep, y)] - smooth[at(x - kStep, y)]);
    std::vector<int> along(change.size(), kFaint + 1);
    std::vector<bool> blank(change.size());
    for (int y = kReach; y < height - kReach; ++y)
        for (int x = kReach; x < width - kReach; ++x) {
            const auto first = change.begin() + y * width + x;
            along[at(x, y)] = *std::max_element(first - kReach, first + kReach + 1);
        }
    for (int y = 2 * kReach; y < height - 2 * kReach; ++y)
        for (int x = kReach; x < width - kReach; ++x) {
            int most = 0;
            for (int j = -kReach; j <= kReach; ++j)
                most = std::max(most, along[at(x, y + j)]);
            blank[at(x, y)] = most <= kFaint;
        }
    return blank;
}

TEST(PlantHonesty, WhatCannotBeMatchedHasNoValueRatherThanAGuess)
{
    if (!data_there("rig-dev/plants"))
        return;
    Place beyond{"beyond the range, or sky"}, hidden{"hidden from the right camera"}, blank{"blank surfaces"},
        pot{"blank pots"}, bright{"saturated surfaces"};
    const int sure = confidence_of_leaves();
    constexpr float kSlack = 1.05F; // the nearest of what is beyond may round into the range
    for (std::size_t plant = 0; plant < kPlants.size(); ++plant)
        for (std::size_t light = 0; light < kLights.size(); ++light) {
            const PlantPair& pair = plant_pair(plant, light);
            const TrueDepth& truth = plant_truth(plant);
            const std::vector<bool> faint = blank_places(pair.left);
            for (std::size_t i = 0; i < truth.pixels(); ++i) {
                const Rgb8 pixel = pair.left.pixels[i];
                if (truth.mm[i] > kSlack * float{kWorkingRange.far_mm})
                    beyond.add(pair, truth, i, sure);
                else if (!within_range(truth.mm[i]))
                    continue;
                else if (truth.hidden[i])
                    hidden.add(pair, truth, i, sure);
                else if (faint[i])
                    (truth.kind[i] == Kind::kPot ? pot : blank).add(pair, truth, i, sure);
                else if (std::max({pixel.r, pixel.g, pixel.b}) >= 250)
                    bright.add(pair, truth, i, sure);
            }
        }
    std::printf(
        "places that cannot be matched: share with a value, share with one more than 10 mm off, and as confident "
        "(%d) as nine of ten leaf pixels\n",
        sure);
    for (const Place* place : {&beyond, &hidden, &blank, &pot, &bright}) {
        std::printf("  %-28s %8ld px: ours %5.2f %%, %5.2f %%, %5.2f %%; SGBM %5.2f %%, %5.2f %%\n", place->name,
                    place->pixels, place->percent(place->ours), place->percent(place->ours_guessed),
                    place->percent(place->ours_sure), place->percent(place->peers),
                    place->percent(place->peers_guessed));
    }
    for (const Place* place : {&blank, &pot, &bright})
        EXPECT_LE(place->percent(place->ours_guessed), 10) << place->name;
    EXPECT_LE(beyond.percent(beyond.ours_guessed), 10);
    EXPECT_LE(hidden.percent(hidden.ours_guessed), 11); // aimed at: 10
    EXPECT_LE(hidden.ours_guessed, hidden.peers_guessed);
}

} // namespace
} // namespace dicot::test
