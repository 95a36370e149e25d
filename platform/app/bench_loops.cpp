#include "bench_loops.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace dicot::app {
namespace {

constexpr int kRounds = 5;

/// The most `amount` a second of processor time over some rounds: other programs do not count.
template <typename Work>
double best_rate(double amount, const Work& work)
{
    double best = 0;
    for (int round = 0; round < kRounds; ++round) {
        const std::int64_t start = process_cpu_us();
        work();
        const double seconds = static_cast<double>(std::max<std::int64_t>(process_cpu_us() - start, 1)) * 1e-6;
        best = std::max(best, amount / seconds);
    }
    return best;
}

volatile float g_sink;

} // namespace

double core_clock_hz()
{
    constexpr int kAdditions = 40'000'000;
    return best_rate(kAdditions, [] {
        // Of two registers: some cores add a constant for nothing.
        std::uint64_t chain = 1;
        std::uint64_t step = 3;
        for (int i = 0; i < kAdditions; i += 8) {
            for (int k = 0; k < 8; ++k) {
                asm volatile("" : "+r"(step));
                chain += step;
                asm volatile("" : "+r"(chain)); // keeps each addition
            }
        }
    });
}

double float_loop_terms_per_s()
{
    constexpr int kWindow = 35;
    constexpr int kWidth = 640;
    constexpr int kPixels = 64;
    constexpr int kDisparities = 64;
    const std::vector<float> left(kPixels * kWindow * kWindow, 0.25f);
    const std::vector<float> right((kPixels + kDisparities) * kWindow * kWindow, 0.5f);
    const std::vector<float> cost(kWindow * kWidth, 1.5f);
    return best_rate(double{kPixels} * kDisparities * kWindow * kWindow, [&] {
        float sum = 0;
        for (int x = 0; x < kPixels; ++x) {
            for (int d = 0; d < kDisparities; ++d) {
                const float* l = &left[static_cast<std::size_t>(x * kWindow * kWindow)];
                const float* r = &right[static_cast<std::size_t>((x + d) * kWindow * kWindow)];
                float numerator = 0;
                float denominator = 0;
                for (int row = 0; row < kWindow; ++row) {
                    for (int column = 0; column < kWindow; ++column) {
                        const float w = l[row * kWindow + column] * r[row * kWindow + column];
                        numerator += w * cost[static_cast<std::size_t>(row * kWidth + x + column)];
                        denominator += w;
                    }
                }
                sum += numerator / denominator;
            }
        }
        g_sink = sum;
    });
}

double kernel_terms_per_s(const Kernels& kernels)
{
    constexpr int kColumns = 35;
    constexpr int kPixels = 32;
    constexpr int kDisparities = 64;
    constexpr int kRightStride = kPixels + kDisparities + 16;
    const std::vector<PairU16> left(kColumns * kPixels, PairU16{20000, 10000});
    const std::vector<PairU16> right(kColumns * kRightStride, PairU16{9000, 12000});
    const std::vector<PairU16> costs((kPixels + kColumns) * kDisparities, PairU16{100, 50});
    std::vector<std::uint32_t> numerator(kPixels * kDisparities);
    std::vector<std::uint32_t> denominator(kPixels * kDisparities);
    const AggregateStrip strip{left.data(), right.data(), costs.data(), numerator.data(), denominator.data(),
                               kPixels,     kRightStride, kColumns,     kPixels,          kDisparities};
    // A second of work on a slow core is a tenth of one on a fast core.
    const int calls = &kernels == &kScalarKernels ? 200 : 4000;
    return best_rate(2.0 * kColumns * kPixels * kDisparities * calls, [&] {
        for (int call = 0; call < calls; ++call)
            kernels.aggregate(strip);
    });
}

double peak_terms_per_cycle(const Kernels& kernels)
{
    return std::strcmp(kernels.name, "avx2") == 0 ? 16.0 / (2.5 / 2.0) : 0.0;
}

} // namespace dicot::app
