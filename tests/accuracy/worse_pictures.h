// What spoils a picture, done to its pixels.
#pragma once

#include "calibration_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace dicot::test {

inline std::uint8_t grey_level(double value)
{
    return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
}

/// 35 % of the light below a slanting line through the middle; the edge is 2 px wide.
inline void shade_half(GreyPicture& picture, std::mt19937& /*random*/)
{
    constexpr double kSlope = 0.35;
    constexpr double kLight = 0.35;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const double below_px =
                (y - 0.5 * picture.height - kSlope * (x - 0.5 * picture.width)) / std::sqrt(1 + kSlope * kSlope);
            const double in_shadow = std::clamp(0.5 * (below_px + 1), 0.0, 1.0);
            std::uint8_t& pixel = picture.view().row(y)[x];
            pixel = grey_level(pixel * (1 - (1 - kLight) * in_shadow));
        }
}

/// 300 discs with radii of 1 to 3 px, each of one grey level.
inline void sprinkle_dirt(GreyPicture& picture, std::mt19937& random)
{
    for (int spot = 0; spot < 300; ++spot) {
        const int at_x = static_cast<int>(random() % static_cast<unsigned>(picture.width));
        const int at_y = static_cast<int>(random() % static_cast<unsigned>(picture.height));
        const int radius = 1 + static_cast<int>(random() % 3);
        const auto tone = static_cast<std::uint8_t>(random() % 256);
        for (int y = std::max(0, at_y - radius); y <= std::min(picture.height - 1, at_y + radius); ++y)
            for (int x = std::max(0, at_x - radius); x <= std::min(picture.width - 1, at_x + radius); ++x)
                if ((x - at_x) * (x - at_x) + (y - at_y) * (y - at_y) <= radius * radius)
                    picture.view().row(y)[x] = tone;
    }
}

/// A tenth of the light, and noise with a standard deviation of 2 grey levels: four bytes added up are nearly normal.
inline void dim(GreyPicture& picture, std::mt19937& random)
{
    constexpr double kDeviationOfByte = 73.9;
    for (std::uint8_t& pixel : picture.pixels) {
        const auto dice = static_cast<std::uint32_t>(random());
        const auto sum = static_cast<double>((dice & 255) + (dice >> 8 & 255) + (dice >> 16 & 255) + (dice >> 24));
        pixel = grey_level(0.1 * pixel + (sum - 510) / kDeviationOfByte);
    }
}

/// Gaussian, standard deviation 4 px.
inline void blur(GreyPicture& picture, std::mt19937& /*random*/)
{
    constexpr int kReach = 12;
    std::array<float, 2 * kReach + 1> weights{};
    float all = 0;
    for (int k = -kReach; k <= kReach; ++k)
        all += weights[static_cast<std::size_t>(k + kReach)] = std::exp(-static_cast<float>(k * k) / 32);
    const auto width = static_cast<std::size_t>(picture.width);
    const auto height = static_cast<std::size_t>(picture.height);
    // Both ways a sum of shifted rows; the border's pixels go on outwards.
    std::vector<float> across(width * height);
    std::vector<float> padded(width + 2 * kReach);
    for (std::size_t y = 0; y < height; ++y) {
        const std::uint8_t* const row = picture.pixels.data() + y * width;
        std::fill_n(padded.begin(), kReach, row[0]);
        std::copy_n(row, width, padded.begin() + kReach);
        std::fill_n(padded.end() - kReach, kReach, row[width - 1]);
        float* const into = across.data() + y * width;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            const float weight = weights[k] / all;
            for (std::size_t x = 0; x < width; ++x)
                into[x] += weight * padded[x + k];
        }
    }
    std::vector<float> down(width);
    for (std::size_t y = 0; y < height; ++y) {
        std::ranges::fill(down, 0.0F);
        for (int k = -kReach; k <= kReach; ++k) {
            const auto from = static_cast<std::size_t>(std::clamp(static_cast<int>(y) + k, 0, picture.height - 1));
            const float weight = weights[static_cast<std::size_t>(k + kReach)] / all;
            for (std::size_t x = 0; x < width; ++x)
                down[x] += weight * across[from * width + x];
        }
        std::ranges::transform(down, picture.view().row(static_cast<int>(y)),
                               [](float sum) { return grey_level(static_cast<double>(sum)); });
    }
}

} // namespace dicot::test
