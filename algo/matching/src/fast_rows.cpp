#include "fast_rows.h"

#include <algorithm>

namespace dicot::matching {
namespace {

/// Pixels of a row that are gathered at a time: their sums stay in the first-level cache.
constexpr int kStrip = 32;

std::size_t size_of(int a, int b, int c)
{
    return static_cast<std::size_t>(a) * static_cast<std::size_t>(b) * static_cast<std::size_t>(c);
}

std::uint16_t spatial_weight(std::span<const std::uint16_t> spatial, int radius, FastCell cell)
{
    return cell.in ? spatial[size_of(1, cell.dy + radius, 2 * radius + 1) + static_cast<std::size_t>(cell.dx + radius)]
                   : std::uint16_t{0};
}

/// The pixels that a cell is for the pixels from column `first` of row y; outside ones for a cell that is not in.
LabRow pixels_of(const Planes& planes, int y, int first, FastCell cell)
{
    return cell.in ? moved(planes.lab(y + cell.dy), first + cell.dx) : moved(planes.lab(-1), first);
}

} // namespace

void FastRows::lay_out(Arena& arena, const Scene& scene)
{
    groups_ = scene.radius + 1;
    // Odd numbers of cache lines, so that the groups of a pixel do not fall on the same cache sets.
    left_stride_ = ((scene.width + 15) / 16 | 1) * 16;
    right_stride_ = ((scene.width + scene.axis - 1 + 15) / 16 | 1) * 16;
    ring_ = arena.take<PairU16>(size_of(scene.width, groups_, scene.axis));
    raw_ = arena.take<PairU16>(size_of(1, scene.width + scene.radius, scene.axis));
    for (Weights& weights : weights_) {
        weights.left = arena.take<PairU16>(size_of(1, groups_, left_stride_));
        weights.right = arena.take<PairU16>(size_of(1, groups_, right_stride_));
    }
    numerator_ = arena.take<std::uint32_t>(size_of(1, kStrip, scene.axis));
    denominator_ = arena.take<std::uint32_t>(size_of(1, kStrip, scene.axis));
    quotient_ = arena.take<std::uint16_t>(size_of(1, 1, scene.axis));
    std::fill(ring_.begin(), ring_.end(), PairU16{0, 0});
    restart();
}

void FastRows::restart()
{
    next_gathered_ = -1;
    first_made_ = -1;
}

AggregatedRow FastRows::made_row(const Scene& scene, int k) const
{
    const std::size_t row = size_of(1, scene.width, scene.axis);
    static_assert(kRowsAtATime * sizeof(std::uint16_t) == sizeof(PairU16), "the rows fit where the raw costs were");
    return {&raw_.data()->low + static_cast<std::size_t>(k) * row, row};
}

void FastRows::raw_costs(const Scene& scene, int y)
{
    const std::size_t margin = size_of(1, scene.radius, scene.axis);
    CostRow right = scene.right.cost(y);
    const int back = scene.axis - 1;
    right = {right.red - back, right.green - back, right.blue - back, right.census - back};
    for (PairU16& pair : raw_.first(margin))
        pair.low = 0;
    scene.kernels->match_cost(&raw_[margin].low, scene.width, scene.axis, scene.left.cost(y), right, scene.costs);
    // The other half of the window begins right of the pixel: the same costs, radius + 1 columns further.
    const std::size_t ahead = margin + static_cast<std::size_t>(scene.axis);
    const std::size_t within = raw_.size() - ahead;
    for (std::size_t i = 0; i < within; ++i)
        raw_[i].high = raw_[i + ahead].low;
    for (PairU16& pair : raw_.subspan(within))
        pair.high = 0;
}

void FastRows::weigh(const Scene& scene, int y, int group, FastCell low, FastCell high, Weights& to)
{
    const auto fill = [&](const Planes& planes, std::span<const std::uint16_t> spatial, int first, PairU16* out) {
        const PairU16 both{spatial_weight(spatial, scene.radius, low), spatial_weight(spatial, scene.radius, high)};
        scene.kernels->support_weights(out, scene.width - first, moved(planes.lab(y), first),
                                       pixels_of(planes, y, first, low), pixels_of(planes, y, first, high),
                                       scene.colour.table, both);
    };
    fill(scene.left, scene.left_spatial, 0, &to.left[size_of(1, group, left_stride_)]);
    fill(scene.right, scene.right_spatial, 1 - scene.axis, &to.right[size_of(1, group, right_stride_)]);
}

AggregateStrip FastRows::strip_of(const Scene& scene, const Weights& weights, const PairU16* costs, int x, int pixels)
{
    std::fill_n(numerator_.begin(), pixels * scene.axis, 0u);
    std::fill_n(denominator_.begin(), pixels * scene.axis, 0u);
    return {&weights.left[static_cast<std::size_t>(x)],
            &weights.right[static_cast<std::size_t>(x)],
            costs,
            numerator_.data(),
            denominator_.data(),
            left_stride_,
            right_stride_,
            groups_,
            pixels,
            scene.axis};
}

void FastRows::gather_row(const Scene& scene, int y)
{
    const int slot = y % (2 * groups_);
    for (int x0 = 0; x0 < scene.width; x0 += kStrip) {
        const int count = std::min(kStrip, scene.width - x0);
        scene.kernels->aggregate(strip_of(scene, weights_[0], &raw_[size_of(1, x0, scene.axis)], x0, count));
        for (int i = 0; i < count; ++i) {
            const auto [first, last] = candidates_of(scene, x0 + i);
            if (last < first)
                continue;
            const std::size_t at = size_of(1, i, scene.axis) + static_cast<std::size_t>(first);
            scene.kernels->normalise(quotient_.data(), &numerator_[at], &denominator_[at], last - first + 1);
            PairU16* to = &ring_[size_of(x0 + i, groups_, scene.axis) + size_of(1, slot / 2, scene.axis)];
            std::uint16_t* half = slot % 2 == 0 ? &to->low : &to->high;
            for (int r = first; r <= last; ++r)
                half[2 * r] = quotient_[static_cast<std::size_t>(r - first)] / 256;
        }
    }
}

void FastRows::gather_columns(const Scene& scene, int rows)
{
    for (int x = 0; x < scene.width; ++x) {
        const auto [first, last] = candidates_of(scene, x);
        for (int k = 0; k < rows; ++k) {
            std::uint16_t* to = &made_row(scene, k)[size_of(1, x, scene.axis)];
            std::fill_n(to, scene.axis, kNoCandidate);
            if (last < first)
                continue;
            scene.kernels->aggregate(strip_of(scene, weights_[k], &ring_[size_of(x, groups_, scene.axis)], x, 1));
            const auto at = static_cast<std::size_t>(first);
            scene.kernels->normalise(to + first, &numerator_[at], &denominator_[at], last - first + 1);
        }
    }
}

AggregatedRow FastRows::row(const Scene& scene, int y, MatchTimes& times, std::uint64_t (*now_ns)())
{
    if (first_made_ >= 0 && y > first_made_ && y < first_made_ + kRowsAtATime)
        return made_row(scene, y - first_made_);
    std::uint64_t since = now_ns ? now_ns() : 0;
    const auto lap = [&](std::uint64_t& stage) {
        const std::uint64_t now = now_ns ? now_ns() : 0;
        stage += now - since;
        since = now;
    };

    const int rows = std::min(kRowsAtATime, scene.height - y);
    const int last = std::min(y + rows - 1 + scene.radius, scene.height - 1);
    if (next_gathered_ < 0)
        next_gathered_ = std::max(y - scene.radius, 0);
    for (; next_gathered_ <= last; ++next_gathered_) {
        raw_costs(scene, next_gathered_);
        lap(times.cost);
        for (int g = 0; g < groups_; ++g)
            weigh(scene, next_gathered_, g, {g - scene.radius, 0, true}, {g + 1, 0, g < scene.radius}, weights_[0]);
        lap(times.weights);
        gather_row(scene, next_gathered_);
        lap(times.aggregate);
    }
    for (int k = 0; k < rows; ++k) {
        for (int g = 0; g < groups_; ++g) {
            const GroupRows pair = rows_of_group(scene, y + k, g);
            weigh(scene, y + k, g, {0, pair.low - y - k, pair.low_in}, {0, pair.high - y - k, pair.high_in},
                  weights_[k]);
        }
    }
    lap(times.weights);
    gather_columns(scene, rows);
    lap(times.aggregate);
    first_made_ = y;
    return made_row(scene, 0);
}

} // namespace dicot::matching
