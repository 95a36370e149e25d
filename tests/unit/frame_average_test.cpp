#include "dicot/camera_rig/frame_average.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <vector>

namespace dicot {
namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 60;
using Picture = std::vector<Rgb8>;

ImageView<Rgb8> view(Picture& picture)
{
    return {picture.data(), kWidth, kHeight};
}

Picture plain(int level)
{
    const auto byte = static_cast<std::uint8_t>(level);
    return Picture(std::size_t{kWidth} * kHeight, Rgb8{byte, byte, byte});
}

/// Leaves and a wall, with noise of +-`noise` levels drawn anew from the generator.
Picture noisy(std::mt19937& random, int noise)
{
    Picture picture = plain(0);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const int level = 60 + 100 * ((x / 10 + y / 10) % 2) +
                              static_cast<int>(random() % static_cast<unsigned>(2 * noise + 1)) - noise;
            const auto byte = static_cast<std::uint8_t>(level);
            picture[static_cast<std::size_t>(y * kWidth + x)] = {byte, byte, byte};
        }
    return picture;
}

void put_square(Picture& picture, int x0, int y0, int level)
{
    for (int y = y0; y < y0 + 8; ++y)
        for (int x = x0; x < x0 + 8; ++x)
            picture[static_cast<std::size_t>(y * kWidth + x)] = {static_cast<std::uint8_t>(level), 200, 30};
}

class Averaging
{
public:
    Averaging()
    {
        Arena measure;
        const FrameAverage measured(measure, kWidth, kHeight);
        block_.resize(measure.peak());
        Arena arena{std::span<std::byte>(block_)};
        average.emplace(arena, kWidth, kHeight);
        average->begin();
    }
    std::optional<FrameAverage> average;

private:
    std::vector<std::byte> block_;
};

TEST(FrameAverage, TheSamePictureManyTimesIsThatPicture)
{
    std::mt19937 random(7);
    Picture picture = noisy(random, 20);
    const Picture expected = picture;
    Averaging averaging;
    for (int k = 0; k < FrameAverage::kMostPictures + 3; ++k)
        averaging.average->add(view(picture));
    const AverageFigures figures = averaging.average->finish(view(picture));
    EXPECT_EQ(figures.pictures, FrameAverage::kMostPictures);
    EXPECT_EQ(figures.moving_pixels, 0);
    EXPECT_EQ(picture, expected);
}

TEST(FrameAverage, NoiseIsHalvedByEightPictures)
{
    std::mt19937 random(11);
    Averaging averaging;
    Picture single;
    for (int k = 0; k < 8; ++k) {
        single = noisy(random, 6);
        averaging.average->add(view(single));
    }
    const auto squared_error = [](const Picture& picture) {
        double sum = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const double off =
                    picture[static_cast<std::size_t>(y * kWidth + x)].g - (60 + 100 * ((x / 10 + y / 10) % 2));
                sum += off * off;
            }
        return sum;
    };
    const double before = squared_error(single);
    const AverageFigures figures = averaging.average->finish(view(single));
    EXPECT_EQ(figures.moving_pixels, 0);
    EXPECT_LT(squared_error(single), before / 4);
}

TEST(FrameAverage, WhatMovesIsKeptFromTheOnePictureAndLeavesNoGhost)
{
    std::mt19937 random(13);
    Averaging averaging;
    std::vector<Picture> pictures;
    for (int k = 0; k < 8; ++k) {
        pictures.push_back(noisy(random, 4));
        put_square(pictures.back(), 10 + 5 * k, 20, 250);
        averaging.average->add(view(pictures.back()));
    }
    Picture kept = pictures[3];
    const Picture sharp = pictures[3];
    const AverageFigures figures = averaging.average->finish(view(kept));
    EXPECT_FALSE(figures.whole);
    EXPECT_GE(figures.moving_pixels, (7 * 5 + 8) * 8);
    EXPECT_LT(figures.moving_pixels, kWidth * kHeight / 4);
    for (int y = 20; y < 28; ++y)
        for (int x = 10; x < 10 + 7 * 5 + 8; ++x) {
            const auto i = static_cast<std::size_t>(y * kWidth + x);
            EXPECT_EQ(kept[i], sharp[i]) << x << "," << y;
        }
    EXPECT_NE(kept, sharp); // elsewhere it is an average
}

TEST(FrameAverage, APictureThatMovesAsAWholeIsTakenAsItIs)
{
    Averaging averaging;
    std::mt19937 random(17);
    Picture dark = noisy(random, 2);
    Picture moved = dark; // the bright squares have become the dark ones
    for (Rgb8& pixel : moved)
        pixel = pixel.g > 110 ? Rgb8{60, 60, 60} : Rgb8{160, 160, 160};
    for (int k = 0; k < 4; ++k) {
        averaging.average->add(view(dark));
        averaging.average->add(view(moved));
    }
    Picture kept = dark;
    const AverageFigures figures = averaging.average->finish(view(kept));
    EXPECT_TRUE(figures.whole); // although half of all pixels jump, and no median tells that
    EXPECT_EQ(kept, dark);
}

TEST(FrameAverage, ASharperPictureHasTheGreaterFigure)
{
    Picture sharp = plain(20);
    Picture soft = plain(20);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto step = static_cast<std::uint8_t>(x < 40 ? 20 : 220);
            const auto ramp = static_cast<std::uint8_t>(std::clamp(20 + (x - 35) * 20, 20, 220));
            sharp[static_cast<std::size_t>(y * kWidth + x)] = {step, step, step};
            soft[static_cast<std::size_t>(y * kWidth + x)] = {ramp, ramp, ramp};
        }
    EXPECT_GT(sharpness_q8(view(sharp)), 2 * sharpness_q8(view(soft)));
    // One step of 200 levels in each of 79 neighbours: 200 * 200 * 256 / 79.
    EXPECT_EQ(sharpness_q8(view(sharp)), 200U * 200U * 256U / 79U);
}

} // namespace
} // namespace dicot
