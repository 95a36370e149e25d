// What dicot match really takes, beside what dicot memory says that it will take.
#include "noise_picture.h"
#include "temp_folder.h"
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>

namespace dicot {
namespace {

constexpr double kMiB = 1 << 20;

struct Case
{
    int width, height, disparities;
    double limit_mib; ///< of the whole process, at the full window
};
constexpr Case kWebcam{640, 480, 64, 48};
constexpr Case kWide{1280, 720, 128, 96};

/// The system's memory is not dicot's own under sanitizers.
bool measurable(const char* test)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    std::printf("NOT RUN: %s: sanitizers take memory of their own\n", test);
    return false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    std::printf("NOT RUN: %s: sanitizers take memory of their own\n", test);
    return false;
#endif
#endif
    (void)test;
    return true;
}

nlohmann::json report_of(const std::string& words)
{
    const test::ToolRun run = test::run(std::string{DICOT_PROGRAM} + " " + words + " --json");
    EXPECT_EQ(run.exit_code, 0) << words << "\n" << run.output;
    return run.exit_code == 0 ? nlohmann::json::parse(run.output) : nlohmann::json::object();
}

double predicted_bytes(const Case& size, const std::string& words, const char* what)
{
    return report_of("memory --width " + std::to_string(size.width) + " --height " + std::to_string(size.height) +
                     " --disparities " + std::to_string(size.disparities) + words)
        .value(what, 0.0);
}

/// Matches two pictures of noise and compares the peak.
void compare(const Case& size, int window, int threads, const char* output)
{
    const test::TempFolder folder;
    const std::string words = " --window " + std::to_string(window) + " --threads " + std::to_string(threads);
    const std::string pair = folder.write("left.ppm", test::noise_ppm(size.width, size.height, 1)) + " " +
                             folder.write("right.ppm", test::noise_ppm(size.width, size.height, 2));
    const double predicted = predicted_bytes(size, words, "total_bytes");
    const double real = report_of("match " + pair + " -o " + folder.path(output) + " --disparities " +
                                  std::to_string(size.disparities) + words)
                            .value("peak_memory_bytes", 0.0);
    std::printf("%d x %d x %d, window %d, %d threads, %s: predicted %.1f MiB, real %.1f MiB\n", size.width, size.height,
                size.disparities, window, threads, output, predicted / kMiB, real / kMiB);
    ASSERT_GT(real, 0);
    EXPECT_GE(predicted, real) << "a prediction that is too low is a promise broken in the field";
    EXPECT_LE(predicted, 1.1 * real);
}

// A small window takes the same planes and smaller tables, and an hour's work in seconds.
TEST(Memory, ThePredictionHoldsWithinTenPercentForWebcamPictures)
{
    if (!measurable("Memory.ThePredictionHoldsWithinTenPercentForWebcamPictures"))
        return;
    for (const int threads : {1, 2})
        for (const char* output : {"map.pfm", "map.png"})
            compare(kWebcam, 5, threads, output);
}

TEST(Memory, ThePredictionHoldsWithinTenPercentForWidePictures)
{
    if (!measurable("Memory.ThePredictionHoldsWithinTenPercentForWidePictures"))
        return;
    for (const int threads : {1, 2})
        compare(kWide, 5, threads, "map.pfm");
}

TEST(Memory, ThePredictionHoldsWithinTenPercentAtTheFullWindow)
{
    if (!measurable("Memory.ThePredictionHoldsWithinTenPercentAtTheFullWindow"))
        return;
    compare(kWebcam, 35, 2, "map.png");
}

TEST(Memory, TheBudgetsHoldAtTheFullWindow)
{
    if (!measurable("Memory.TheBudgetsHoldAtTheFullWindow"))
        return;
    for (const Case& size : {kWebcam, kWide}) {
        for (const int threads : {1, 2, 4}) {
            const double bytes =
                predicted_bytes(size, " --window 35 --dense --threads " + std::to_string(threads), "total_bytes");
            std::printf("%d x %d x %d, %d threads: %.1f MiB of %.0f\n", size.width, size.height, size.disparities,
                        threads, bytes / kMiB, size.limit_mib);
            EXPECT_GT(bytes, 0);
            EXPECT_LE(bytes, size.limit_mib * kMiB);
        }
    }
}

} // namespace
} // namespace dicot
