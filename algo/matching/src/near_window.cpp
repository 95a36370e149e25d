#include "near_window.h"

#include "cost_rows.h"

#include <algorithm>
#include <cstring>

namespace dicot::matching {
namespace {

constexpr int kRadius = NearWindow::kRadius;
constexpr int kColumns = 2 * kRadius + 1;
constexpr int kGroups = kRadius + 1;
/// Its spatial weights are exp(-r / kReach).
constexpr double kReach = 4;

std::size_t size_of(int a, int b)
{
    return static_cast<std::size_t>(a) * static_cast<std::size_t>(b);
}

PairU16 spatial_pair(std::span<const std::uint16_t> spatial, int low_row, bool low_in, bool high_in, int column)
{
    const auto weight = [&](int row, bool in) {
        return in ? spatial[size_of(row, kColumns) + static_cast<std::size_t>(column)] : std::uint16_t{0};
    };
    return {weight(low_row, low_in), weight(low_row + 1, high_in)};
}

} // namespace

void NearWindow::lay_out(Arena& arena, const Scene& scene)
{
    right_stride_ = ((kStrip + scene.axis - 1 + 15) / 16 | 1) * 16;
    left_spatial_ = arena.take<std::uint16_t>(size_of(kColumns, kColumns));
    right_spatial_ = arena.take<std::uint16_t>(size_of(kColumns, kColumns));
    left_ = arena.take<PairU16>(size_of(kColumns, kStrip));
    right_ = arena.take<PairU16>(size_of(kGroups, kColumns) * static_cast<std::size_t>(right_stride_));
}

void NearWindow::clear()
{
    if (!left_spatial_.empty())
        fill_spatial_weights(left_spatial_.data(), right_spatial_.data(), kRadius, kReach);
}

void NearWindow::aggregate(const Scene& scene, int y, int x0, int count, const RawCosts& raw, std::uint32_t* numerator,
                           std::uint32_t* denominator)
{
    // The first strip of a row makes all right positions that it needs; the others keep those that they share.
    const int overlap = scene.axis - 1;
    const int kept = x0 == 0 ? 0 : overlap;
    const int first = x0 == 0 ? -overlap : x0;
    const int made = x0 == 0 ? overlap + count : count;
    const LabRow left_centre = moved(scene.left.lab(y), x0);
    const LabRow right_centre = moved(scene.right.lab(y), first);
    // Rows low and low + 1 share a group when low is even.
    PairU16* right = right_.data();
    for (int low = (y - kRadius) & ~1; low <= y + kRadius; low += 2, right += size_of(kColumns, right_stride_)) {
        const auto inside = [&](int row) {
            return row >= std::max(y - kRadius, 0) && row <= std::min(y + kRadius, scene.height - 1);
        };
        const bool low_in = inside(low);
        const bool high_in = inside(low + 1);
        if (!low_in && !high_in)
            continue;
        const int low_window = low - (y - kRadius);
        for (int c = 0; c < kColumns; ++c) {
            const auto rows_of = [&](const Planes& planes, int from, int row, bool in) {
                return moved(planes.lab(in ? row : -1), from - kRadius + c);
            };
            scene.kernels->support_weights(left_.data() + size_of(c, kStrip), count, left_centre,
                                           rows_of(scene.left, x0, low, low_in),
                                           rows_of(scene.left, x0, low + 1, high_in), scene.colour.table,
                                           spatial_pair(left_spatial_, low_window, low_in, high_in, c));
            PairU16* const column = right + size_of(c, right_stride_);
            std::memmove(column, column + kStrip, static_cast<std::size_t>(kept) * sizeof(PairU16));
            scene.kernels->support_weights(column + kept, made, right_centre, rows_of(scene.right, first, low, low_in),
                                           rows_of(scene.right, first, low + 1, high_in), scene.colour.table,
                                           spatial_pair(right_spatial_, low_window, low_in, high_in, c));
        }
        const int group = low % (2 * raw.groups()) / 2;
        AggregateStrip strip{};
        strip.left_weights = left_.data();
        strip.right_weights = right;
        strip.costs = raw.group(scene, group, x0 - kRadius);
        strip.numerator = numerator;
        strip.denominator = denominator;
        strip.left_stride = kStrip;
        strip.right_stride = right_stride_;
        strip.columns = kColumns;
        strip.pixels = count;
        strip.disparities = scene.axis;
        scene.kernels->aggregate(strip);
    }
}

} // namespace dicot::matching
