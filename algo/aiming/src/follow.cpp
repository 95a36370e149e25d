#include "follow.h"

#include <array>
#include <cmath>

namespace dicot::aiming {
namespace {

/// Windows are compared that reach so far from their middle, at places up to kSearch around the expected one.
constexpr int kRadius = 4;
constexpr int kSearch = 2;
constexpr int kPixels = (2 * kRadius + 1) * (2 * kRadius + 1);
/// Least correlation on the way down, and in the full pictures, where noise is strongest.
constexpr double kAlike = 0.7;
constexpr double kAlikeInFull = 0.5;

bool inside(Grey picture, int x, int y, int margin)
{
    return x >= margin && y >= margin && x < picture.width - margin && y < picture.height - margin;
}

/// Correlation of two windows, -1 .. 1, whatever the light; 0 where one is flat.
double likeness(Grey left, int xl, int yl, Grey right, int xr, int yr)
{
    std::int32_t a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (int dy = -kRadius; dy <= kRadius; ++dy) {
        const std::uint8_t* const l = left.row(yl + dy) + xl;
        const std::uint8_t* const r = right.row(yr + dy) + xr;
        for (int dx = -kRadius; dx <= kRadius; ++dx) {
            const std::int32_t p = l[dx], q = r[dx];
            a += p;
            b += q;
            aa += p * p;
            bb += q * q;
            ab += p * q;
        }
    }
    const std::int64_t var_a = std::int64_t{kPixels} * aa - std::int64_t{a} * a;
    const std::int64_t var_b = std::int64_t{kPixels} * bb - std::int64_t{b} * b;
    const std::int64_t both = std::int64_t{kPixels} * ab - std::int64_t{a} * b;
    if (var_a <= 0 || var_b <= 0)
        return 0;
    return static_cast<double>(both) / std::sqrt(static_cast<double>(var_a) * static_cast<double>(var_b));
}

/// Where the parabola through three values, the middle one the largest, has its top: -0.5 .. 0.5.
double top_of(double before, double middle, double after)
{
    const double bend = 2 * middle - before - after;
    return bend > 0 ? (after - before) / (2 * bend) : 0;
}

struct Likenesses
{
    std::array<std::array<double, 2 * kSearch + 1>, 2 * kSearch + 1> at{};
    int x = kSearch, y = kSearch; ///< of the best

    double best() const { return value(0, 0); }
    double value(int dx, int dy) const
    {
        return at[static_cast<std::size_t>(y + dy)][static_cast<std::size_t>(x + dx)];
    }
    bool at_rim() const { return x == 0 || y == 0 || x == 2 * kSearch || y == 2 * kSearch; }
};

Likenesses compare(Grey left, Grey right, const Pair& pair)
{
    Likenesses all;
    for (int y = 0; y <= 2 * kSearch; ++y)
        for (int x = 0; x <= 2 * kSearch; ++x) {
            double& value = all.at[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
            value =
                likeness(left, pair.left_x, pair.left_y, right, pair.right_x + x - kSearch, pair.right_y + y - kSearch);
            if (value > all.best()) {
                all.x = x;
                all.y = y;
            }
        }
    return all;
}

} // namespace

std::optional<Sight> follow(const Levels& left, const Levels& right, Pair pair)
{
    for (int k = pair.level; k >= 0; --k) {
        const Grey l = left.level[static_cast<std::size_t>(k)], r = right.level[static_cast<std::size_t>(k)];
        if (!inside(l, pair.left_x, pair.left_y, kRadius) || !inside(r, pair.right_x, pair.right_y, kRadius + kSearch))
            return std::nullopt;
        const Likenesses found = compare(l, r, pair);
        if (found.at_rim() || found.best() < (k == 0 ? kAlikeInFull : kAlike))
            return std::nullopt;
        pair.right_x += found.x - kSearch;
        pair.right_y += found.y - kSearch;
        if (k == 0) {
            const double x = pair.right_x + top_of(found.value(-1, 0), found.best(), found.value(1, 0));
            const double y = pair.right_y + top_of(found.value(0, -1), found.best(), found.value(0, 1));
            return Sight{pair.left_x - (l.width - 1) / 2.0, pair.left_y - (l.height - 1) / 2.0, pair.left_x - x,
                         y - pair.left_y};
        }
        pair = {k - 1, 2 * pair.left_x, 2 * pair.left_y, 2 * pair.right_x, 2 * pair.right_y};
    }
    return std::nullopt;
}

} // namespace dicot::aiming
