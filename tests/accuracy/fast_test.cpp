// What the fast method promises of its time.
#include "matched.h"
#include "scenes.h"

#include "dicot/os/clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>

namespace dicot {
namespace {

// Processor time of one thread, each method's best of some runs: other programs on the machine hardly count.
TEST(Fast, TakesAtMostThreeTwentiethsOfTheTimeOfStandard)
{
    constexpr int kWidth = 640, kHeight = 480, kRuns = 3;
    constexpr double kMostOfStandard = 0.15;
    std::mt19937 random(1);
    scenes::Picture left{kWidth, kHeight, {}};
    for (int i = 0; i < kWidth * kHeight; ++i)
        left.pixels.push_back({static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
                               static_cast<std::uint8_t>(random())});
    scenes::Picture right = left;
    std::rotate(right.pixels.begin(), right.pixels.begin() + 10, right.pixels.end());
    const auto least_seconds = [&](MatchMethod method) {
        MatchOptions options;
        options.method = method;
        double least = 1e9;
        for (int run = 0; run < kRuns; ++run) {
            const std::int64_t start = process_cpu_us();
            const Matched matched(left.view(), right.view(), options, nullptr, 1);
            least = std::min(least, static_cast<double>(process_cpu_us() - start) * 1e-6);
        }
        return least;
    };
    const double fast = least_seconds(MatchMethod::kFast);
    const double standard = least_seconds(MatchMethod::kStandard);
    std::printf("%d x %d x %d: fast %.3f s, standard %.3f s of processor, %.3f of it\n", kWidth, kHeight,
                MatchOptions{}.disparities, fast, standard, fast / standard);
    EXPECT_LE(fast, kMostOfStandard * standard);
}

} // namespace
} // namespace dicot
