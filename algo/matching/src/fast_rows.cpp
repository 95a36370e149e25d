#include "fast_rows.h"

#include <algorithm>
#include <cstdlib>

namespace dicot::matching {
namespace {

/// Pixels of a row that are gathered at a time: their sums stay in the first-level cache.
constexpr int kStrip = 32;

std::size_t size_of(int a, int b, int c)
{
    return static_cast<std::size_t>(a) * static_cast<std::size_t>(b) * static_cast<std::size_t>(c);
}

std::uint16_t spatial_weight(std::span<const std::uint16_t> spatial, int radius, WindowCell cell)
{
    return cell.in ? spatial[size_of(1, cell.dy + radius, 2 * radius + 1) + static_cast<std::size_t>(cell.dx + radius)]
                   : std::uint16_t{0};
}

/// What a cell is for the pixels from column `first` of row y.
LabRow pixels_of(const Planes& planes, int y, int first, WindowCell cell)
{
    return cell.in ? moved(planes.lab(y + cell.dy), first + cell.dx) : moved(planes.lab(-1), first);
}

} // namespace

void FastRows::lay_out(Arena& arena, const Scene& scene)
{
    row_groups_ = scene.radius + 1;
    column_groups_ = scene.radius / kRowStep + 1;
    // Odd numbers of cache lines, so that the groups of a pixel do not fall on the same cache sets.
    left_stride_ = ((scene.width + 15) / 16 | 1) * 16;
    right_stride_ = ((scene.width + scene.axis - 1 + 15) / 16 | 1) * 16;
    ring_ = arena.take<PairU16>(size_of(scene.width, kRowStep * column_groups_, scene.axis));
    raw_ = arena.take<PairU16>(size_of(1, scene.width + scene.radius, scene.axis));
    left_ = arena.take<PairU16>(size_of(1, row_groups_, left_stride_));
    right_ = arena.take<PairU16>(size_of(1, row_groups_, right_stride_));
    numerator_ = arena.take<std::uint32_t>(size_of(1, kStrip, scene.axis));
    denominator_ = arena.take<std::uint32_t>(size_of(1, kStrip, scene.axis));
    quotient_ = arena.take<std::uint16_t>(size_of(1, 1, scene.axis));
    std::fill(ring_.begin(), ring_.end(), PairU16{0, 0});
    restart();
}

void FastRows::raw_costs(const Scene& scene, int y)
{
    const std::size_t margin = size_of(1, scene.radius, scene.axis);
    CostRow right = scene.right.cost(y);
    const int back = scene.axis - 1;
    right = {right.red - back, right.green - back, right.blue - back, right.census - back};
    scene.kernels->match_cost(&raw_[margin].low, scene.width, scene.axis, scene.left.cost(y), right, scene.costs);
    // Cells outside the picture weigh nothing, but the contract wants a cost.
    for (PairU16& pair : raw_.first(margin))
        pair.low = 0;
    // The right half of the row begins one column after the centre: the same costs, radius + 1 columns further.
    const std::size_t ahead = margin + static_cast<std::size_t>(scene.axis);
    const std::size_t within = raw_.size() - ahead;
    for (std::size_t i = 0; i < within; ++i)
        raw_[i] = {raw_[i].low, raw_[i + ahead].low};
    for (PairU16& pair : raw_.subspan(within))
        pair.high = 0;
}

void FastRows::weigh(const Scene& scene, int y, int group, WindowCell low, WindowCell high)
{
    const auto fill = [&](const Planes& planes, std::span<const std::uint16_t> spatial, int first, PairU16* out) {
        const PairU16 both{spatial_weight(spatial, scene.radius, low), spatial_weight(spatial, scene.radius, high)};
        scene.kernels->support_weights(out, scene.width - first, moved(planes.lab(y), first),
                                       pixels_of(planes, y, first, low), pixels_of(planes, y, first, high),
                                       scene.colour.table, both);
    };
    fill(scene.left, scene.left_spatial, 0, &left_[size_of(1, group, left_stride_)]);
    fill(scene.right, scene.right_spatial, 1 - scene.axis, &right_[size_of(1, group, right_stride_)]);
}

void FastRows::row_weights(const Scene& scene, int y)
{
    for (int g = 0; g < row_groups_; ++g)
        weigh(scene, y, g, {g - scene.radius, 0, true}, {g + 1, 0, g < scene.radius});
}

void FastRows::column_weights(const Scene& scene, int y)
{
    // Rows of y's parity are counted apart: number n of them lies in slot n mod 2 column_groups_.
    const int slots = 2 * column_groups_;
    const int top = y / kRowStep - scene.radius / kRowStep;
    const auto cell = [&](int slot) {
        const int step = ((slot - top) % slots + slots) % slots - scene.radius / kRowStep;
        const int dy = kRowStep * step;
        return WindowCell{0, dy, std::abs(dy) <= scene.radius && y + dy >= 0 && y + dy < scene.height};
    };
    for (int g = 0; g < column_groups_; ++g)
        weigh(scene, y, g, cell(2 * g), cell(2 * g + 1));
}

PairU16* FastRows::ring_at(const Scene& scene, int x, int y)
{
    return &ring_[size_of(x * kRowStep + y % kRowStep, column_groups_, scene.axis)];
}

AggregateStrip FastRows::strip_of(const Scene& scene, const PairU16* costs, int x, int pixels, int groups)
{
    std::fill_n(numerator_.begin(), pixels * scene.axis, 0u);
    std::fill_n(denominator_.begin(), pixels * scene.axis, 0u);
    AggregateStrip strip{};
    strip.left_weights = &left_[static_cast<std::size_t>(x)];
    strip.right_weights = &right_[static_cast<std::size_t>(x)];
    strip.costs = costs;
    strip.numerator = numerator_.data();
    strip.denominator = denominator_.data();
    strip.left_stride = left_stride_;
    strip.right_stride = right_stride_;
    strip.columns = groups;
    strip.pixels = pixels;
    strip.disparities = scene.axis;
    return strip;
}

void FastRows::gather_row(const Scene& scene, int y)
{
    const int slot = y / kRowStep % (2 * column_groups_);
    const std::size_t group = size_of(1, slot / 2, scene.axis);
    for (int x0 = 0; x0 < scene.width; x0 += kStrip) {
        const int count = std::min(kStrip, scene.width - x0);
        scene.kernels->aggregate(strip_of(scene, &raw_[size_of(1, x0, scene.axis)], x0, count, row_groups_));
        for (int i = 0; i < count; ++i) {
            const auto [first, last] = candidates_of(scene, x0 + i);
            if (last < first)
                continue;
            const std::size_t at = size_of(1, i, scene.axis) + static_cast<std::size_t>(first);
            const auto n = static_cast<std::size_t>(last - first + 1);
            std::uint16_t* const quotient = quotient_.data();
            scene.kernels->normalise(quotient, &numerator_[at], &denominator_[at], static_cast<int>(n));
            PairU16* to = ring_at(scene, x0 + i, y) + group + first;
            if (slot % 2 == 0)
                for (std::size_t r = 0; r < n; ++r)
                    to[r] = {static_cast<std::uint16_t>(quotient[r] >> 8), to[r].high};
            else
                for (std::size_t r = 0; r < n; ++r)
                    to[r] = {to[r].low, static_cast<std::uint16_t>(quotient[r] >> 8)};
        }
    }
}

AggregatedRow FastRows::made_row(const Scene& scene) const
{
    return {&raw_.data()->low, size_of(1, scene.width, scene.axis)};
}

void FastRows::gather_columns(const Scene& scene, int y)
{
    const AggregatedRow made = made_row(scene);
    std::fill(made.begin(), made.end(), kNoCandidate);
    for (int x = 0; x < scene.width; ++x) {
        const auto [first, last] = candidates_of(scene, x);
        if (last < first)
            continue;
        scene.kernels->aggregate(strip_of(scene, ring_at(scene, x, y), x, 1, column_groups_));
        const auto at = static_cast<std::size_t>(first);
        scene.kernels->normalise(&made[size_of(1, x, scene.axis) + at], &numerator_[at], &denominator_[at],
                                 last - first + 1);
    }
}

AggregatedRow FastRows::row(const Scene& scene, int y, MatchTimes& times, std::uint64_t (*now_ns)())
{
    std::uint64_t since = now_ns ? now_ns() : 0;
    const auto lap = [&](std::uint64_t& stage) {
        const std::uint64_t now = now_ns ? now_ns() : 0;
        stage += now - since;
        since = now;
    };

    const int reach = scene.radius / kRowStep * kRowStep;
    const int last = std::min(y + reach, scene.height - 1);
    if (next_gathered_ < 0)
        next_gathered_ = std::max(y - reach, 0);
    for (; next_gathered_ <= last; ++next_gathered_) {
        raw_costs(scene, next_gathered_);
        lap(times.cost);
        row_weights(scene, next_gathered_);
        lap(times.weights);
        gather_row(scene, next_gathered_);
        lap(times.aggregate);
    }
    column_weights(scene, y);
    lap(times.weights);
    gather_columns(scene, y);
    lap(times.aggregate);
    return made_row(scene);
}

} // namespace dicot::matching
