// The law: the shortest loops that a reader can hold against the paper and the contract in kernels.h.
#include "dicot/kernels/kernels.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdlib>

namespace dicot {
namespace {

int colour_index(int squared_distance)
{
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(squared_distance));
    const int index = static_cast<int>(bits >> 17) - (127 * kColourSteps - 1);
    return index < 0 ? 0 : index;
}

int squared_distance(LabRow p, LabRow q, int i)
{
    const int l = p.la[i].low - q.la[i].low;
    const int a = p.la[i].high - q.la[i].high;
    const int b = p.b[i].low - q.b[i].low;
    return l * l + a * a + b * b;
}

std::uint32_t round_q15(std::uint32_t product)
{
    return (product + (1u << 14)) >> 15;
}

void support_weights(PairU16* out, int n, LabRow p, LabRow q_low, LabRow q_high, const std::uint16_t* colour,
                     PairU16 spatial)
{
    for (int i = 0; i < n; ++i) {
        const std::uint32_t low = colour[colour_index(squared_distance(p, q_low, i))];
        const std::uint32_t high = colour[colour_index(squared_distance(p, q_high, i))];
        out[i].low = static_cast<std::uint16_t>(round_q15(low * spatial.low));
        out[i].high = static_cast<std::uint16_t>(round_q15(high * spatial.high));
    }
}

void match_cost(std::uint16_t* out, int n, int disparities, CostRow left, CostRow right, const CostTables& tables)
{
    for (int i = 0; i < n; ++i) {
        for (int r = 0; r < disparities; ++r) {
            const int j = i + r;
            const int difference = std::abs(left.red[i] - right.red[j]) + std::abs(left.green[i] - right.green[j]) +
                                   std::abs(left.blue[i] - right.blue[j]);
            const int hamming = std::popcount(static_cast<std::uint8_t>(left.census[i] ^ right.census[j]));
            out[(i * disparities + r) * 2] =
                static_cast<std::uint16_t>(tables.difference[difference] + tables.census[hamming]);
        }
    }
}

void aggregate(const AggregateStrip& s)
{
    for (int i = 0; i < s.pixels; ++i) {
        for (int r = 0; r < s.disparities; ++r) {
            std::uint32_t numerator = 0;
            std::uint32_t denominator = 0;
            for (int c = 0; c < s.columns; ++c) {
                const PairU16 left = s.left_weights[c * s.left_stride + i];
                const PairU16 right = s.right_weights[c * s.right_stride + i + r];
                const PairU16 cost = s.costs[(i + c) * s.disparities + r];
                const std::uint32_t low = round_q15(std::uint32_t{left.low} * right.low);
                const std::uint32_t high = round_q15(std::uint32_t{left.high} * right.high);
                numerator += low * cost.low + high * cost.high;
                denominator += low + high;
            }
            s.numerator[i * s.disparities + r] += numerator;
            s.denominator[i * s.disparities + r] += denominator;
        }
    }
}

void normalise(std::uint16_t* out, const std::uint32_t* numerator, const std::uint32_t* denominator, int n)
{
    for (int i = 0; i < n; ++i)
        out[i] = static_cast<std::uint16_t>(std::uint64_t{numerator[i]} * 256 / denominator[i]);
}

std::uint16_t path_step(std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                        std::uint16_t least, PathPenalty penalty, int first, int axis)
{
    // What cannot be seen is neither better nor worse than the worst of what can.
    int worst = 0;
    for (int r = first; r < axis; ++r)
        worst = std::max(worst, costs[r] == kNoCandidate ? 0 : int{costs[r]});

    std::fill(ahead, ahead + first, kNoCandidate);
    int least_ahead = kNoCandidate;
    for (int r = first; r < axis; ++r) {
        int best = std::min<int>(behind[r], least + penalty.large);
        if (r > first)
            best = std::min(best, behind[r - 1] + penalty.small);
        if (r + 1 < axis)
            best = std::min(best, behind[r + 1] + penalty.small);
        const int path = std::min<int>(costs[r], worst) + best - least;
        ahead[r] = static_cast<std::uint16_t>(path);
        least_ahead = std::min(least_ahead, path);
    }
    return static_cast<std::uint16_t>(least_ahead);
}

void winners(Winner* out, const std::uint16_t* costs, int n, int axis)
{
    for (int i = 0; i < n; ++i, costs += axis) {
        int position = 0;
        for (int r = 1; r < axis; ++r)
            if (costs[r] <= costs[position])
                position = r;
        std::uint16_t runner_up = kNoCandidate;
        for (int r = 0; r < axis; ++r)
            if (std::abs(r - position) > 1)
                runner_up = std::min(runner_up, costs[r]);
        out[i] = {static_cast<std::uint16_t>(position), costs[position], runner_up};
    }
}

void right_winners(std::uint16_t* cost, std::uint16_t* position, const std::uint16_t* costs, int n, int axis)
{
    if (n == 0)
        return;
    std::fill(cost, cost + n + axis - 1, kNoCandidate);
    std::fill(position, position + n + axis - 1, std::uint16_t{0});
    // Seen from a fixed entry, r falls as i grows: strictly less keeps the largest r.
    for (int i = 0; i < n; ++i) {
        for (int r = 0; r < axis; ++r) {
            if (costs[i * axis + r] < cost[i + r]) {
                cost[i + r] = costs[i * axis + r];
                position[i + r] = static_cast<std::uint16_t>(r);
            }
        }
    }
}

void remap_row(std::uint8_t* rgb, int n, const RemapSpan* spans, int cell_log2, const RemapSource& source)
{
    for (int i = 0; i < n; ++i) {
        const RemapSpan& span = spans[i >> cell_log2];
        const int u = i & ((1 << cell_log2) - 1);
        const int x = (span.x + u * span.dx + (1 << 8)) >> 9;
        const int y = (span.y + u * span.dy + (1 << 8)) >> 9;
        const bool inside = x >= 0 && y >= 0 && x <= 128 * (source.width - 1) && y <= 128 * (source.height - 1);
        for (int channel = 0; channel < 3; ++channel) {
            const auto pixel = [&](int column, int row) -> int {
                return source.rgb[std::ptrdiff_t{row} * source.stride_bytes + 3 * column + channel];
            };
            int value = 0;
            if (inside) {
                // On the last column or row the second of the two weighs nothing.
                const int left = x >> 7, right = left + (x % 128 != 0), a = x & 127;
                const int above = y >> 7, below = above + (y % 128 != 0), b = y & 127;
                value = ((128 - b) * ((128 - a) * pixel(left, above) + a * pixel(right, above)) +
                         b * ((128 - a) * pixel(left, below) + a * pixel(right, below)) + (1 << 13)) >>
                        14;
            }
            rgb[3 * i + channel] = static_cast<std::uint8_t>(value);
        }
    }
}

} // namespace

const Kernels kScalarKernels = {"scalar",  support_weights, match_cost,    aggregate, normalise,
                                path_step, winners,         right_winners, remap_row};

} // namespace dicot
