#include "places.h"

#include "dicot/drift/drift.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace dicot::drift {
namespace {

/// px, of a cell's sides: small pictures have fewer cells.
constexpr int kLeastCell = 8;
/// Places that are looked at in a cell, along each axis.
constexpr int kTries = 6;
/// Texture is looked for in a window that reaches so far.
constexpr int kTextureReach = 4;
constexpr int kTexturePixels = (2 * kTextureReach + 1) * (2 * kTextureReach + 1);
/// The least mean square, in the weaker direction, of what is two pixels further; noise of 2 levels makes 8.
constexpr double kLeastTexture = 24;
/// The matcher's word for how much better its choice is than the next one.
constexpr int kLeastConfidence = 24;
/// On one surface neighbours have almost the same disparity.
constexpr int kSameSurface = 1 << kDispFractionBits;
/// Of the places of the window that are asked, so many must lie on it.
constexpr int kAskEvery = 3;
constexpr int kLeastAnswers = 18;

bool lies_on_a_surface(const DisparityMap& map, int x, int y)
{
    const int middle = map.relative.at(x, y);
    if (middle == kDispMissing || map.confidence.at(x, y) < kLeastConfidence)
        return false;
    int answers = 0;
    for (int dy = -kRadius; dy <= kRadius; dy += kAskEvery)
        for (int dx = -kRadius; dx <= kRadius; dx += kAskEvery) {
            const int other = map.relative.at(x + dx, y + dy);
            if (other == kDispMissing)
                continue;
            if (std::abs(other - middle) > kSameSurface)
                return false;
            ++answers;
        }
    return answers >= kLeastAnswers;
}

/// The smaller eigenvalue of the gradients' scatter (Shi and Tomasi 1994), a pixel.
double texture(Grey grey, int x, int y)
{
    std::int32_t xx = 0, xy = 0, yy = 0;
    for (int dy = -kTextureReach; dy <= kTextureReach; ++dy) {
        const std::uint8_t* const above = grey.row(y + dy - 1) + x;
        const std::uint8_t* const here = grey.row(y + dy) + x;
        const std::uint8_t* const below = grey.row(y + dy + 1) + x;
        for (int dx = -kTextureReach; dx <= kTextureReach; ++dx) {
            const std::int32_t across = here[dx + 1] - here[dx - 1];
            const std::int32_t down = below[dx] - above[dx];
            xx += across * across;
            xy += across * down;
            yy += down * down;
        }
    }
    const double difference = xx - yy;
    const double both = 2.0 * xy;
    return (xx + yy - std::sqrt(difference * difference + both * both)) / (2 * kTexturePixels);
}

} // namespace

Cells cells_of(int width, int height) noexcept
{
    Cells cells{1, 1};
    while (std::int64_t{cells.columns + 1} * (cells.columns + 1) * height <=
           std::int64_t{EpipolarDrift::kMostPoints} * width)
        ++cells.columns;
    cells.rows = EpipolarDrift::kMostPoints / cells.columns;
    return {std::clamp(width / kLeastCell, 1, cells.columns), std::clamp(height / kLeastCell, 1, cells.rows)};
}

std::optional<Place> textured_place(Grey left, const DisparityMap& map, const Cells& cells, int column,
                                    int row) noexcept
{
    std::optional<Place> best;
    double most = kLeastTexture;
    for (int j = 0; j < kTries; ++j)
        for (int i = 0; i < kTries; ++i) {
            const int x = (column * kTries + i) * left.width / (cells.columns * kTries);
            const int y = (row * kTries + j) * left.height / (cells.rows * kTries);
            constexpr int kRim = kRadius + 1;
            if (x < kRim || y < kRim || x >= left.width - kRim || y >= left.height - kRim ||
                !lies_on_a_surface(map, x, y))
                continue;
            if (const double there = texture(left, x, y); there > most) {
                most = there;
                best = Place{x, y, map.min_disparity + map.relative.at(x, y) / double{1 << kDispFractionBits}};
            }
        }
    return best;
}

} // namespace dicot::drift
