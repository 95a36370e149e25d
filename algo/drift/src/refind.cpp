#include "refind.h"

#include "dicot/drift/drift.h"

#include <array>
#include <cmath>
#include <limits>

namespace dicot::drift {
namespace {

constexpr int kRounds = 10;
/// The search ends with a step shorter than this, px.
constexpr double kSettled = 0.005;
/// How far the matcher's disparity may be off, px; places that lead further were matched wrongly.
constexpr double kMostAside = 1.5;
/// Least correlation of both windows, brightness and contrast free.
constexpr double kAlike = 0.85;

using Window = std::array<double, kPixels>;

bool inside(Grey picture, double x, double y)
{
    return x >= kRadius && y >= kRadius && x < picture.width - kRadius - 1 && y < picture.height - kRadius - 1;
}

/// Takes the mean off; the sum of squares of what remains.
double centre(Window& window)
{
    double sum = 0;
    for (const double value : window)
        sum += value;
    const double mean = sum / kPixels;
    double squares = 0;
    for (double& value : window) {
        value -= mean;
        squares += value * value;
    }
    return squares;
}

/// The left picture around the place, and how it changes there.
struct Template
{
    Window level, across, down;
    double squares = 0;
    double xx = 0, xy = 0, yy = 0; ///< scatter of the changes

    Template(Grey left, int x, int y)
    {
        std::size_t i = 0;
        for (int dy = -kRadius; dy <= kRadius; ++dy)
            for (int dx = -kRadius; dx <= kRadius; ++dx, ++i) {
                const std::uint8_t* const here = left.row(y + dy) + x + dx;
                level[i] = *here;
                across[i] = (here[1] - here[-1]) / 2.0;
                down[i] = (here[left.stride] - here[-left.stride]) / 2.0;
                xx += across[i] * across[i];
                xy += across[i] * down[i];
                yy += down[i] * down[i];
            }
        squares = centre(level);
    }
};

/// The right picture between its pixels, linearly.
void sample(Grey right, double x, double y, Window& window)
{
    const int left = static_cast<int>(x), top = static_cast<int>(y);
    const double fx = x - left, fy = y - top;
    std::size_t i = 0;
    for (int dy = -kRadius; dy <= kRadius; ++dy) {
        const std::uint8_t* const upper = right.row(top + dy) + left;
        const std::uint8_t* const lower = right.row(top + dy + 1) + left;
        for (int dx = -kRadius; dx <= kRadius; ++dx, ++i) {
            const double above = upper[dx] + fx * (upper[dx + 1] - upper[dx]);
            const double below = lower[dx] + fx * (lower[dx + 1] - lower[dx]);
            window[i] = above + fy * (below - above);
        }
    }
}

/// The row, out of whole ones, that is most alike; brightness free.
int nearest_row(Grey left, Grey right, const Place& place)
{
    constexpr int kReach = EpipolarDrift::kReachPx;
    const int x = static_cast<int>(place.x - place.disparity_px + 0.5);
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    int best = 0;
    for (int rise = -kReach; rise <= kReach; ++rise) {
        if (!inside(right, x, place.y + rise))
            continue;
        std::int32_t sum = 0, squares = 0;
        for (int dy = -kRadius; dy <= kRadius; ++dy) {
            const std::uint8_t* const l = left.row(place.y + dy) + place.x;
            const std::uint8_t* const r = right.row(place.y + rise + dy) + x;
            for (int dx = -kRadius; dx <= kRadius; ++dx) {
                const std::int32_t difference = r[dx] - l[dx];
                sum += difference;
                squares += difference * difference;
            }
        }
        const std::int64_t cost = std::int64_t{kPixels} * squares - std::int64_t{sum} * sum;
        if (cost < least) {
            least = cost;
            best = rise;
        }
    }
    return best;
}

} // namespace

std::optional<Sight> refind(Grey left, Grey right, const Place& place) noexcept
{
    const double from_x = place.x - place.disparity_px;
    if (!inside(right, from_x, place.y))
        return std::nullopt;
    const Template wanted(left, place.x, place.y);
    const double scatter = wanted.xx * wanted.yy - wanted.xy * wanted.xy;
    if (scatter <= 0 || wanted.squares <= 0)
        return std::nullopt;
    double x = from_x, y = place.y + nearest_row(left, right, place);
    Window seen;
    for (int round = 0; round < kRounds; ++round) {
        if (!inside(right, x, y))
            return std::nullopt;
        sample(right, x, y, seen);
        const double squares = centre(seen);
        double both = 0;
        for (std::size_t i = 0; i < seen.size(); ++i)
            both += seen[i] * wanted.level[i];
        if (both <= 0 || squares <= 0)
            return std::nullopt;
        const double gain = both / squares;
        double right_by = 0, down_by = 0;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            const double difference = wanted.level[i] - gain * seen[i];
            right_by += wanted.across[i] * difference;
            down_by += wanted.down[i] * difference;
        }
        const double step_x = (wanted.yy * right_by - wanted.xy * down_by) / scatter;
        const double step_y = (wanted.xx * down_by - wanted.xy * right_by) / scatter;
        x += step_x;
        y += step_y;
        if (std::fabs(x - from_x) > kMostAside || std::fabs(y - place.y) > EpipolarDrift::kReachPx + 0.5)
            return std::nullopt;
        if (std::fabs(step_x) >= kSettled || std::fabs(step_y) >= kSettled)
            continue;
        if (both < kAlike * std::sqrt(squares * wanted.squares))
            return std::nullopt;
        return Sight{x, y, y - place.y};
    }
    return std::nullopt;
}

} // namespace dicot::drift
