// Disparities between pixels, on a plane that slants, drawn by its equation.
#include "matched.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace dicot {
namespace {

constexpr int kWidth = 220, kHeight = 120;
constexpr double kAt = 10, kAcross = 0.12, kDown = 0.05; // px, px a column, px a row

double disparity_at(double x, double y)
{
    return kAt + kAcross * x + kDown * y;
}

/// Waves of 4 to 20 px, so that any place between pixels has a value.
class Texture
{
public:
    Texture()
    {
        std::mt19937 random(5);
        const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
        for (Wave& wave : waves_) {
            const double direction = 6.28318 * uniform(), length = 4 + 16 * uniform();
            wave = {6.28318 / length * std::cos(direction), 6.28318 / length * std::sin(direction),
                    6.28318 * uniform()};
        }
    }
    double at(double x, double y) const
    {
        double sum = 0;
        for (const Wave& wave : waves_)
            sum += std::sin(wave.across * x + wave.down * y + wave.phase);
        return 128 + 14 * sum;
    }

private:
    struct Wave
    {
        double across, down, phase;
    };
    std::array<Wave, 24> waves_;
};

scenes::Picture drawn(const Texture& texture, bool right)
{
    scenes::Picture picture{kWidth, kHeight, {}};
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            // x_right = x - disparity(x, y), solved for x.
            const double on_wall = right ? (x + kAt + kDown * y) / (1 - kAcross) : x;
            const auto level = static_cast<std::uint8_t>(std::clamp(std::lround(texture.at(on_wall, y)), 0L, 255L));
            picture.pixels.push_back({level, level, level});
        }
    return picture;
}

TEST(Surfaces, ASlantedPlaneIsFoundBetweenPixels)
{
    const Texture texture;
    const scenes::Picture left = drawn(texture, false), right = drawn(texture, true);
    MatchOptions options;
    options.method = MatchMethod::kBest;
    options.disparities = 60;
    const Matched matched(left.view(), right.view(), options);
    std::vector<double> sizes;
    std::array<double, 8> by_fraction{};
    std::array<int, 8> counts{};
    int pixels = 0;
    for (int y = 15; y < kHeight - 15; ++y)
        for (int x = 60; x < kWidth - 15; ++x) {
            const DispQ8 value = matched.map().relative.at(x, y);
            ++pixels;
            if (value == kDispMissing)
                continue;
            const double is = disparity_at(x, y), error = value / 256.0 - is;
            sizes.push_back(std::abs(error));
            const auto eighth = static_cast<std::size_t>((is - std::floor(is)) * 8);
            by_fraction[eighth] += error;
            ++counts[eighth];
        }
    ASSERT_GE(static_cast<double>(sizes.size()), 0.98 * pixels);
    std::ranges::sort(sizes);
    const double most = sizes[sizes.size() * 95 / 100];
    double pull = 0;
    for (std::size_t i = 0; i < counts.size(); ++i)
        pull = std::max(pull, std::abs(by_fraction[i] / counts[i]));
    std::printf("95 %% within %.3f px, mean error of an eighth of a pixel at most %.3f px\n", most, pull);
    EXPECT_LE(most, 0.05);
    EXPECT_LE(pull, 0.02); // whole pixels do not attract
}

} // namespace
} // namespace dicot
