// Light that a surface mirrors towards one camera alone.
#include "matched.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dicot {
namespace {

constexpr int kWidth = 200, kHeight = 120, kShift = 14;
constexpr int kLeft = 80, kRight = 130, kTop = 35, kBottom = 85; // the highlight, px of the left picture

std::uint8_t level(double value)
{
    return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

/// A smooth texture and the same `kShift` px further left.
struct WallPair
{
    scenes::Picture left{kWidth, kHeight, {}}, right{kWidth, kHeight, {}};

    /// `seen(x, y, of the wall)` is what the left camera sees of the wall within the highlight's place.
    template <typename Seen>
    explicit WallPair(Seen seen)
    {
        constexpr int kWide = kWidth + 64;
        std::mt19937 random(3);
        std::vector<double> noise(static_cast<std::size_t>(kWide) * (kHeight + 2));
        for (double& value : noise)
            value = static_cast<double>(random() % 256);
        const auto wall = [&](int x, int y) {
            double sum = 0;
            for (int dy = 0; dy < 3; ++dy)
                for (int dx = 0; dx < 3; ++dx)
                    sum += noise[static_cast<std::size_t>((y + dy) * kWide + x + dx)];
            return 30 + sum / 9 * 0.6;
        };
        const auto grey = [](double value) { return Rgb8{level(value), level(value), level(value)}; };
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const bool inside = x >= kLeft && x < kRight && y >= kTop && y < kBottom;
                left.pixels.push_back(grey(inside ? seen(x, y, wall(x, y)) : wall(x, y)));
                right.pixels.push_back(grey(wall(x + kShift, y)));
            }
    }
};

/// Windows see what stands beside them.
constexpr int kRim = 8;

/// Of the highlight's pixels, kRim from its rim: those with a value, and those within half a pixel of the truth.
struct Found
{
    int pixels = 0, valued = 0, right = 0;

    explicit Found(const WallPair& pair)
    {
        MatchOptions options;
        options.method = MatchMethod::kBest;
        options.min_disparity = 5;
        options.disparities = 32;
        const Matched matched(pair.left.view(), pair.right.view(), options);
        for (int y = kTop + kRim; y < kBottom - kRim; ++y)
            for (int x = kLeft + kRim; x < kRight - kRim; ++x) {
                const DispQ8 value = matched.map().relative.at(x, y);
                ++pixels;
                valued += value != kDispMissing;
                right += value != kDispMissing && std::abs(5 + value / 256.0 - kShift) < 0.5;
                EXPECT_TRUE(value == kDispMissing || matched.map().confidence.at(x, y) > 0);
            }
    }
};

TEST(Highlights, AWallInOtherLightIsWhereItIs)
{
    // 120 grey levels brighter in the middle, with half of the contrast, and less so towards the rim.
    const Found found(WallPair([](int x, int y, double wall) {
        const double dx = (x - 105) / 25.0, dy = (y - 60) / 25.0;
        const double light = std::max(0.0, 1 - dx * dx) * std::max(0.0, 1 - dy * dy);
        return wall + light * (120 - 0.5 * wall);
    }));
    std::printf("%d px: %d have a value, %d the right one\n", found.pixels, found.valued, found.right);
    EXPECT_GE(found.right, found.pixels * 95 / 100);
    EXPECT_GE(found.right, found.valued * 99 / 100);
}

TEST(Highlights, WhatIsNotOnTheWallGetsNoValue)
{
    std::mt19937 random(9);
    const Found other(WallPair([&](int, int, double) { return 150 + static_cast<double>(random() % 100); }));
    std::printf("%d px of something else: %d have a value\n", other.pixels, other.valued);
    EXPECT_LE(other.valued, other.pixels / 20);
    const Found blank(WallPair([&](int, int, double) { return 255.0; }));
    EXPECT_LE(blank.valued, blank.pixels / 100);
}

} // namespace
} // namespace dicot
