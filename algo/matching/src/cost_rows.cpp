#include "cost_rows.h"

#include <algorithm>
#include <cstring>

namespace dicot::matching {
namespace {

constexpr int kStrip = NearWindow::kStrip;
/// Parts of 256 that the wide window's cost has beside the narrow one's.
constexpr int kFarShare = 205;

std::size_t size_of(int a, int b, int c)
{
    return static_cast<std::size_t>(a) * static_cast<std::size_t>(b) * static_cast<std::size_t>(c);
}

} // namespace

Candidates candidates_of(const Scene& scene, int x)
{
    // Relative disparities whose partner is a column 0 .. width - 1 of the picture, which is shifted in the search
    // frame.
    const int nearest = std::max(0, x - (scene.width - 1 + scene.min_disparity));
    const int farthest = std::min(scene.disparities - 1, x - scene.min_disparity);
    return {scene.axis - 1 - farthest, scene.axis - 1 - nearest};
}

/// The two picture rows of a group when row y is matched, and where they lie in the window.
struct CostRows::GroupRows
{
    int low, high;               ///< picture rows
    int low_window, high_window; ///< window rows 0 .. 2 radius
    bool low_in, high_in;        ///< inside the window and inside the picture
};

void CostRows::lay_out(Arena& arena, const Scene& scene, const RawCosts* shared)
{
    columns_ = 2 * scene.radius + 1;
    shared_ = shared;
    if (!shared)
        own_.lay_out(arena, scene, columns_);
    groups_ = raw().groups();
    // An odd number of cache lines, so that the columns of a group do not fall on the same cache sets.
    right_stride_ = ((kStrip + scene.axis - 1 + 15) / 16 | 1) * 16;
    left_ = arena.take<PairU16>(size_of(groups_, columns_, kStrip));
    right_ = arena.take<PairU16>(size_of(groups_, columns_, right_stride_));
    numerator_ = arena.take<std::uint32_t>(size_of(1, kStrip, scene.axis));
    denominator_ = arena.take<std::uint32_t>(size_of(1, kStrip, scene.axis));
    row_ = arena.take<std::uint16_t>(size_of(1, scene.width, scene.axis));
    if (scene.near_window) {
        near_row_ = arena.take<std::uint16_t>(size_of(1, 1, scene.axis));
        near_.lay_out(arena, scene);
    }
    clear();
}

void CostRows::clear()
{
    own_.clear();
    near_.clear();
    std::fill(left_.begin(), left_.end(), PairU16{0, 0});
    std::fill(right_.begin(), right_.end(), PairU16{0, 0});
    restart();
}

CostRows::GroupRows CostRows::rows_of_group(const Scene& scene, int y, int group) const
{
    const int slots = 2 * groups_;
    const int top = y - scene.radius;
    const auto window_row = [&](int slot) { return ((slot - top) % slots + slots) % slots; };
    GroupRows rows{};
    rows.low_window = window_row(2 * group);
    rows.high_window = window_row(2 * group + 1);
    rows.low = top + rows.low_window;
    rows.high = top + rows.high_window;
    rows.low_in = rows.low_window < columns_ && rows.low >= 0 && rows.low < scene.height;
    rows.high_in = rows.high_window < columns_ && rows.high >= 0 && rows.high < scene.height;
    return rows;
}

namespace {

PairU16 spatial_pair(std::span<const std::uint16_t> spatial, int columns, int low_row, bool low_in, int high_row,
                     bool high_in, int column)
{
    const auto weight = [&](int row, bool in) {
        return in ? spatial[size_of(1, row, columns) + static_cast<std::size_t>(column)] : std::uint16_t{0};
    };
    return {weight(low_row, low_in), weight(high_row, high_in)};
}

} // namespace

void CostRows::left_weights(const Scene& scene, int y, int x0, int count)
{
    const LabRow centre = moved(scene.left.lab(y), x0);
    for (int g = 0; g < groups_; ++g) {
        const GroupRows rows = rows_of_group(scene, y, g);
        if (!rows.low_in && !rows.high_in)
            continue;
        const LabRow low = moved(scene.left.lab(rows.low_in ? rows.low : -1), x0 - scene.radius);
        const LabRow high = moved(scene.left.lab(rows.high_in ? rows.high : -1), x0 - scene.radius);
        for (int c = 0; c < columns_; ++c)
            scene.kernels->support_weights(left_.data() + size_of(g, columns_, kStrip) + size_of(1, c, kStrip), count,
                                           centre, moved(low, c), moved(high, c), scene.colour.table,
                                           spatial_pair(scene.left_spatial, columns_, rows.low_window, rows.low_in,
                                                        rows.high_window, rows.high_in, c));
    }
}

void CostRows::right_weights(const Scene& scene, int y, int first, int count, int at)
{
    const LabRow centre = moved(scene.right.lab(y), first);
    for (int g = 0; g < groups_; ++g) {
        const GroupRows rows = rows_of_group(scene, y, g);
        if (!rows.low_in && !rows.high_in)
            continue;
        const LabRow low = moved(scene.right.lab(rows.low_in ? rows.low : -1), first - scene.radius);
        const LabRow high = moved(scene.right.lab(rows.high_in ? rows.high : -1), first - scene.radius);
        for (int c = 0; c < columns_; ++c) {
            PairU16* column = right_.data() + size_of(g, columns_, right_stride_) + size_of(1, c, right_stride_);
            if (at > 0) // the positions shared with the strip before
                std::memmove(column, column + kStrip, static_cast<std::size_t>(at) * sizeof(PairU16));
            scene.kernels->support_weights(column + at, count, centre, moved(low, c), moved(high, c),
                                           scene.colour.table,
                                           spatial_pair(scene.right_spatial, columns_, rows.low_window, rows.low_in,
                                                        rows.high_window, rows.high_in, c));
        }
    }
}

void CostRows::aggregate(const Scene& scene, int y, int x0, int count)
{
    std::fill(numerator_.begin(), numerator_.end(), 0u);
    std::fill(denominator_.begin(), denominator_.end(), 0u);
    for (int g = 0; g < groups_; ++g) {
        const GroupRows rows = rows_of_group(scene, y, g);
        if (!rows.low_in && !rows.high_in)
            continue;
        AggregateStrip strip{};
        strip.left_weights = left_.data() + size_of(g, columns_, kStrip);
        strip.right_weights = right_.data() + size_of(g, columns_, right_stride_);
        strip.costs = raw().group(scene, g, x0 - scene.radius);
        strip.numerator = numerator_.data();
        strip.denominator = denominator_.data();
        strip.left_stride = kStrip;
        strip.right_stride = right_stride_;
        strip.columns = columns_;
        strip.pixels = count;
        strip.disparities = scene.axis;
        scene.kernels->aggregate(strip);
    }
}

void CostRows::divide(const Scene& scene, int x0, int count)
{
    for (int i = 0; i < count; ++i) {
        const int x = x0 + i;
        const auto [first, last] = candidates_of(scene, x);
        const auto to = row_.begin() + x * scene.axis;
        std::fill(to, to + scene.axis, kNoCandidate);
        if (last < first)
            continue;
        const std::size_t at = static_cast<std::size_t>(i * scene.axis + first);
        scene.kernels->normalise(&to[first], numerator_.data() + at, denominator_.data() + at, last - first + 1);
    }
}

void CostRows::mix_near(const Scene& scene, int y, int x0, int count)
{
    std::fill(numerator_.begin(), numerator_.end(), 0u);
    std::fill(denominator_.begin(), denominator_.end(), 0u);
    near_.aggregate(scene, y, x0, count, raw(), numerator_.data(), denominator_.data());
    for (int i = 0; i < count; ++i) {
        const auto [first, last] = candidates_of(scene, x0 + i);
        if (last < first)
            continue;
        const std::size_t at = size_of(1, i, scene.axis) + static_cast<std::size_t>(first);
        scene.kernels->normalise(near_row_.data(), numerator_.data() + at, denominator_.data() + at, last - first + 1);
        std::uint16_t* const to = &row_[size_of(1, x0 + i, scene.axis) + static_cast<std::size_t>(first)];
        for (int k = 0; k <= last - first; ++k)
            to[k] = static_cast<std::uint16_t>(
                (to[k] * kFarShare + near_row_[static_cast<std::size_t>(k)] * (256 - kFarShare) + 128) >> 8);
    }
}

AggregatedRow CostRows::row(const Scene& scene, int y, MatchTimes& times, std::uint64_t (*now_ns)())
{
    const auto clock = [&] { return now_ns ? now_ns() : 0; };
    std::uint64_t since = clock();
    const auto lap = [&](std::uint64_t& stage) {
        const std::uint64_t now = clock();
        stage += now - since;
        since = now;
    };

    if (!shared_) {
        const int last = std::min(y + scene.radius, scene.height - 1);
        if (next_cost_row_ < 0)
            next_cost_row_ = std::max(y - scene.radius, 0);
        for (; next_cost_row_ <= last; ++next_cost_row_)
            own_.make(scene, next_cost_row_);
        lap(times.cost);
    }

    const int overlap = scene.axis - 1;
    for (int x0 = 0; x0 < scene.width; x0 += kStrip) {
        const int count = std::min(kStrip, scene.width - x0);
        left_weights(scene, y, x0, count);
        if (x0 == 0)
            right_weights(scene, y, -overlap, overlap + count, 0);
        else
            right_weights(scene, y, x0, count, overlap);
        lap(times.weights);
        aggregate(scene, y, x0, count);
        lap(times.aggregate);
        divide(scene, x0, count);
        lap(times.select);
        if (scene.near_window) {
            mix_near(scene, y, x0, count);
            lap(times.aggregate);
        }
    }
    return row_;
}

} // namespace dicot::matching
