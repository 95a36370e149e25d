// A scene to be seen from two places: spots of any size and brightness, as a function of real coordinates.
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

namespace dicot::test {

/// Goes on for kHalf pixels to every side of (0, 0); the same seed gives the same wall.
class SpottedWall
{
public:
    explicit SpottedWall(unsigned seed)
    {
        std::mt19937 random{seed};
        const auto between = [&](double least, double most) {
            return least + (most - least) * static_cast<double>(random()) / 4294967295.0;
        };
        for (int i = 0; i < 4000; ++i) {
            const Spot spot{between(-kHalf, kHalf), between(-kHalf, kHalf), between(3, kLargest), between(-60, 60)};
            for (int row = cell(spot.y - kLargest); row <= cell(spot.y + kLargest); ++row)
                for (int column = cell(spot.x - kLargest); column <= cell(spot.x + kLargest); ++column)
                    near_[index(column, row)].push_back(spot);
        }
    }
    double at(double x, double y) const
    {
        double level = 128;
        for (const Spot& spot : near_[index(cell(x), cell(y))]) {
            const double dx = (x - spot.x) / spot.radius, dy = (y - spot.y) / spot.radius;
            if (const double squared = dx * dx + dy * dy; squared < 1)
                level += spot.height * (1 - squared);
        }
        return level;
    }

private:
    struct Spot
    {
        double x, y, radius, height;
    };
    static constexpr double kHalf = 600, kLargest = 14;
    static constexpr int kCells = 100;

    static int cell(double position)
    {
        return std::clamp(static_cast<int>((position + kHalf) * kCells / (2 * kHalf)), 0, kCells - 1);
    }
    static std::size_t index(int column, int row) { return static_cast<std::size_t>(row * kCells + column); }

    std::vector<std::vector<Spot>> near_{kCells * kCells};
};

} // namespace dicot::test
