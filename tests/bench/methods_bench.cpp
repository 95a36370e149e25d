// What the methods of matching cost beside each other, in one run. Times are printed; what is judged is the match.
#include "matched.h"
#include "scenes.h"

#include "dicot/os/clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>

namespace dicot {
namespace {

constexpr int kWidth = 640, kHeight = 480, kShift = 10;

/// Noise, and the same noise `kShift` px further left.
struct NoisePair
{
    scenes::Picture left{kWidth, kHeight, {}}, right;

    NoisePair()
    {
        std::mt19937 random(1);
        const auto value = [&] { return static_cast<std::uint8_t>(random()); };
        for (int i = 0; i < kWidth * kHeight; ++i)
            left.pixels.push_back({value(), value(), value()});
        right = left;
        std::rotate(right.pixels.begin(), right.pixels.begin() + kShift, right.pixels.end());
    }
};

struct Cost
{
    double seconds;       ///< of one thread's processor, the least of some runs
    double found_percent; ///< of the pixels, those that have the shift
};

Cost cost_of(const NoisePair& pair, MatchMethod method)
{
    constexpr int kRuns = 2;
    MatchOptions options;
    options.method = method;
    Cost cost{1e9, 0};
    for (int run = 0; run < kRuns; ++run) {
        const std::int64_t start = process_cpu_us();
        const Matched matched(pair.left.view(), pair.right.view(), options, nullptr, 1);
        cost.seconds = std::min(cost.seconds, static_cast<double>(process_cpu_us() - start) * 1e-6);
        long found = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                found += std::abs(matched.map().relative.at(x, y) - kShift * 256) <= 64;
        cost.found_percent = 100.0 * static_cast<double>(found) / (kWidth * kHeight);
    }
    return cost;
}

TEST(MethodsBench, EachFindsTheShiftAndItsTimeIsPrinted)
{
    const NoisePair pair;
    const Cost standard = cost_of(pair, MatchMethod::kStandard);
    std::printf("%d x %d x %d, one thread:\n", kWidth, kHeight, MatchOptions{}.disparities);
    const auto print = [&](const char* name, const Cost& cost) {
        std::printf("  %-8s %6.3f s of processor, %.3f of standard; %.1f %% of the pixels found\n", name, cost.seconds,
                    cost.seconds / standard.seconds, cost.found_percent);
        EXPECT_GE(cost.found_percent, 95) << name;
    };
    print("paper", cost_of(pair, MatchMethod::kPaper));
    print("fast", cost_of(pair, MatchMethod::kFast));
    print("standard", standard);
    print("best", cost_of(pair, MatchMethod::kBest));
}

} // namespace
} // namespace dicot
