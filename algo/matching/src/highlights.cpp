#include "highlights.h"

#include "plane_sums.h"
#include "scene_plane.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace dicot::matching {
namespace {

/// The correlation's window: 15 x 15 px.
constexpr int kReach = 7;
constexpr int kSide = 2 * kReach + 1, kArea = kSide * kSide;
/// Squares of the least correlation that counts, 0.6, as a fraction.
constexpr std::int64_t kLeastOver = 9, kLeastUnder = 25;
/// A variance of 4 grey levels^2 is noise.
constexpr std::int64_t kNoise = 4LL * kArea * kArea;
/// A variance of 16 is the least texture that can tell places apart.
constexpr std::int64_t kTexture = 16LL * kArea * kArea;
constexpr int kStrip = 64;
/// Columns of the right picture that a strip may have for partners.
constexpr int kPartners = kStrip + kMaxDisparities - 1;

/// The neighbourhood that settles a pixel, of which every second row and column is looked at, and of that: how many
/// must have been found and lie on the plane (2 of 3 that were asked, and a quarter of all: narrow gaps lie between two
/// surfaces), how near to it (at first: to the median), and how much the brightness must differ in the mean.
constexpr int kAround = 12, kStride = 2;
constexpr int kSideAround = 2 * kAround / kStride + 1;
constexpr int kFewest = kSideAround * kSideAround / 4;
constexpr int kMoreBits = 4; // PlaneSums wants 1/4096 px
constexpr int kNearMedian = 3 << 11, kNearPlane = 3 << 10;
constexpr int kOtherLight = 10 * 4; // 1/4 grey level

/// Sums over a window around each of `count` pixels of a row, of what term(column, row) gives; the first pixel is at 0.
template <std::size_t most, typename Term>
void window_sums(std::array<std::int32_t, most>& to, int count, Term&& term)
{
    std::array<std::int32_t, most + 2 * kReach> columns{};
    for (int row = -kReach; row <= kReach; ++row)
        for (int i = 0; i < count + 2 * kReach; ++i)
            columns[static_cast<std::size_t>(i)] += term(i - kReach, row);
    std::int32_t sum = 0;
    for (int i = 0; i < kSide; ++i)
        sum += columns[static_cast<std::size_t>(i)];
    for (int i = 0; i < count; ++i) {
        to[static_cast<std::size_t>(i)] = sum;
        if (i + 1 < count)
            sum += columns[static_cast<std::size_t>(i + kSide)] - columns[static_cast<std::size_t>(i)];
    }
}

/// kArea^2 times the variance, below 2^30.
std::int64_t spread(std::int64_t sum, std::int64_t squares)
{
    return kArea * squares - sum * sum;
}

/// The vertex of the parabola through three scores, of which the middle one is the largest, in 1/256 px.
int vertex_q8(std::int64_t before, std::int64_t at, std::int64_t after)
{
    const std::int64_t curvature = 2 * at - before - after;
    return curvature <= 0 ? 0 : static_cast<int>((after - before) * 128 / curvature);
}

} // namespace

void Highlights::lay_out(Arena& arena, const Scene& scene)
{
    for (ImageView<std::uint8_t>* plane : {&left_, &right_, &asked_, &differs_})
        *plane = take_plane<std::uint8_t>(arena, scene);
    found_ = take_plane<DispQ8>(arena, scene);
}

void Highlights::read_row(const Scene& scene, const Maps& maps, int y)
{
    // ITU-R BT.601 luma.
    const auto brightness = [](CostRow row, int x) {
        return static_cast<std::uint8_t>((77 * row.red[x] + 150 * row.green[x] + 29 * row.blue[x]) >> 8);
    };
    const CostRow left = scene.left.cost(y);
    const CostRow right = scene.right.cost(y);
    for (int x = 0; x < scene.width; ++x) {
        found_.row(y)[x] = kDispMissing;
        asked_.row(y)[x] = maps.disparity.row(y)[x] == kDispMissing || maps.confidence.row(y)[x] < kConfidence;
        left_.row(y)[x] = brightness(left, x);
        // Columns outside the search frame are in nobody's window.
        const int in_frame = x + scene.min_disparity;
        const bool inside = in_frame > -scene.axis - kReach && in_frame < scene.width + kReach;
        right_.row(y)[x] = inside ? brightness(right, in_frame) : std::uint8_t{0};
    }
}

void Highlights::correlate_row(const Scene& scene, int y)
{
    if (y % kStride != 0 || y < kReach || y >= scene.height - kReach)
        return;
    for (int x0 = kReach; x0 < scene.width - kReach; x0 += kStrip) {
        const int count = std::min(kStrip, scene.width - kReach - x0);
        const std::uint8_t* asked = asked_.row(y) + x0;
        if (std::find(asked, asked + count, 1) != asked + count)
            correlate(scene, y, x0, count);
    }
}

void Highlights::correlate(const Scene& scene, int y, int x0, int count)
{
    const auto square = [](std::int32_t level) { return level * level; };
    std::array<std::int32_t, kStrip> left, left_squares, products;
    window_sums(left, count, [&](int i, int row) { return std::int32_t{left_.row(y + row)[x0 + i]}; });
    window_sums(left_squares, count, [&](int i, int row) { return square(left_.row(y + row)[x0 + i]); });
    bool any = false;
    for (int i = 0; i < count; ++i) {
        const auto here = static_cast<std::size_t>(i);
        any |= asked_.row(y)[x0 + i] && spread(left[here], left_squares[here]) >= kTexture;
    }
    if (!any)
        return;
    // Partners' columns from the farthest to the nearest, those whose windows lie in the right picture.
    const int first_column = std::max(kReach, x0 - scene.min_disparity - (scene.disparities - 1));
    const int end_column = std::min(scene.width - kReach, x0 + count - scene.min_disparity);
    if (first_column >= end_column)
        return;
    std::array<std::int32_t, kPartners> right, right_squares;
    window_sums(right, end_column - first_column,
                [&](int i, int row) { return std::int32_t{right_.row(y + row)[first_column + i]}; });
    window_sums(right_squares, end_column - first_column,
                [&](int i, int row) { return square(right_.row(y + row)[first_column + i]); });

    struct Correlation
    {
        std::int64_t both = 0, spread = 1;
        std::int64_t score() const { return both > 0 ? both * both / spread : 0; }
    };
    std::array<Correlation, kStrip> last{};
    struct Best
    {
        std::int64_t score = 0, before = 0, after = 0;
        int d = 0;
        std::int32_t apart = 0;
    };
    std::array<Best, kStrip> bests{};
    for (int d = 0; d < scene.disparities; ++d) {
        const int shift = d + scene.min_disparity;
        const int first = std::max(0, kReach + shift - x0);
        const int end = std::min(count, scene.width - kReach + shift - x0);
        if (first >= end)
            continue;
        window_sums(products, end - first, [&](int i, int row) {
            return std::int32_t{left_.row(y + row)[x0 + first + i]} * right_.row(y + row)[x0 + first - shift + i];
        });
        for (int i = first; i < end; ++i) {
            const auto here = static_cast<std::size_t>(i);
            const auto at = static_cast<std::size_t>(x0 + i - shift - first_column);
            const Correlation now = {std::int64_t{kArea} * products[static_cast<std::size_t>(i - first)] -
                                         std::int64_t{left[here]} * right[at],
                                     spread(right[at], right_squares[at]) + kNoise};
            Best& best = bests[here];
            if (now.both > 0 && now.both * now.both > best.score * now.spread)
                best = {now.score(), last[here].score(), 0, d, std::abs(left[here] - right[at])};
            else if (best.d + 1 == d)
                best.after = now.score();
            last[here] = now;
        }
    }
    for (int i = 0; i < count; ++i) {
        const auto here = static_cast<std::size_t>(i);
        const std::int64_t own = spread(left[here], left_squares[here]) + kNoise;
        const Best& best = bests[here];
        if (!asked_.row(y)[x0 + i] || own < kTexture + kNoise || best.score * kLeastUnder < own * kLeastOver)
            continue;
        const bool between = best.d > 0 && best.d + 1 < scene.disparities;
        const int part = between ? vertex_q8(best.before, best.score, best.after) : 0;
        found_.row(y)[x0 + i] = static_cast<DispQ8>((best.d << kDispFractionBits) + part);
        differs_.row(y)[x0 + i] = static_cast<std::uint8_t>(std::min(best.apart * 4 / kArea, 255));
    }
}

void Highlights::settle_row(const Scene& scene, const Maps& maps, int y) const
{
    struct Point
    {
        int dx, dy;
        std::int32_t disparity;
        int differs;
    };
    std::array<Point, kSideAround * kSideAround> points;
    std::array<DispQ8, kSideAround * kSideAround> values;
    for (int x = 0; x < scene.width; ++x) {
        if (!asked_.row(y)[x])
            continue;
        std::size_t asked = 0, found = 0;
        std::int64_t differs = 0;
        for (int dy = y % kStride - kAround; dy <= kAround; dy += kStride) {
            if (y + dy < 0 || y + dy >= scene.height)
                continue;
            for (int dx = -kAround; dx <= kAround; dx += kStride) {
                if (x + dx < 0 || x + dx >= scene.width)
                    continue;
                asked += asked_.row(y + dy)[x + dx];
                const DispQ8 value = found_.row(y + dy)[x + dx];
                if (value == kDispMissing)
                    continue;
                const int differs_here = differs_.row(y + dy)[x + dx];
                values[found] = value;
                points[found++] = {dx, dy, value << kMoreBits, differs_here};
                differs += differs_here;
            }
        }
        const std::size_t fewest = std::max(std::size_t{kFewest}, (2 * asked + 2) / 3);
        if (found < fewest || differs < kOtherLight * static_cast<std::int64_t>(fewest))
            continue;
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(found / 2);
        std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(found));
        const std::int32_t median = *middle << kMoreBits;
        PlaneSums::Plane plane{0, 0, 0};
        std::size_t on_it = 0;
        for (const int near : {kNearMedian, kNearPlane}) {
            PlaneSums sums;
            on_it = 0;
            differs = 0;
            for (std::size_t i = 0; i < found; ++i) {
                const Point& p = points[i];
                const std::int32_t rise = p.disparity - median;
                if (std::abs(rise - plane.centre - plane.across * p.dx - plane.down * p.dy) > near)
                    continue;
                sums.add(1, p.dx, p.dy, rise); // of weight 1: its sums have room for 169 points up to 12 px away
                differs += p.differs;
                ++on_it;
            }
            if (on_it < fewest)
                break;
            plane = sums.plane();
        }
        if (on_it < fewest || differs < kOtherLight * static_cast<std::int64_t>(on_it))
            continue;
        const int value = (median + plane.centre + (1 << (kMoreBits - 1))) >> kMoreBits;
        maps.disparity.row(y)[x] =
            static_cast<DispQ8>(std::clamp(value, 0, (scene.disparities - 1) << kDispFractionBits));
        maps.confidence.row(y)[x] = kConfidence;
        maps.verdict.row(y)[x] = Verdict::kMatched;
    }
}

void Highlights::match(const Scene& scene, const Maps& maps, Crew& crew)
{
    crew.run(scene.height, [&](int y) { read_row(scene, maps, y); });
    crew.run(scene.height, [&](int y) { correlate_row(scene, y); });
    crew.run(scene.height, [&](int y) { settle_row(scene, maps, y); });
}

} // namespace dicot::matching
