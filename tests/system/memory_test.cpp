// What dicot match really takes, beside what dicot memory says that it will take.
#include "noise_picture.h"
#include "temp_folder.h"
#include "tool.h"

#include "dicot/codec/encode_cloud.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

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
void compare(const Case& size, int window, int threads, const char* output, const char* method = "standard")
{
    const test::TempFolder folder;
    const std::string words =
        " --window " + std::to_string(window) + " --threads " + std::to_string(threads) + " --method " + method;
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

TEST(Memory, ThePredictionHoldsWithinTenPercentForTheOtherMethods)
{
    if (!measurable("Memory.ThePredictionHoldsWithinTenPercentForTheOtherMethods"))
        return;
    for (const char* method : {"paper", "fast", "best"})
        for (const int threads : {1, 2})
            compare(kWebcam, 15, threads, "map.pfm", method);
}

TEST(Memory, ThePredictionHoldsWithinTenPercentAtTheFullWindow)
{
    if (!measurable("Memory.ThePredictionHoldsWithinTenPercentAtTheFullWindow"))
        return;
    compare(kWebcam, 35, 2, "map.png");
}

/// One side of a pair whose every pixel has a partner `shift` px further left.
std::string textured_ppm(const test::TempFolder& folder, const char* name, const Case& size, int shift)
{
    const std::string head = "P6 " + std::to_string(size.width) + " " + std::to_string(size.height) + " 255\n";
    test::Bytes file(head.begin(), head.end());
    std::mt19937 random{7};
    std::vector<std::uint8_t> noise(static_cast<std::size_t>(size.width + 64) * 3);
    for (int y = 0; y < size.height; ++y) {
        for (std::uint8_t& value : noise)
            value = static_cast<std::uint8_t>(random());
        file.insert(file.end(), noise.begin() + 3 * shift, noise.begin() + 3 * (shift + size.width));
    }
    return folder.write(name, file);
}

/// Parallel cameras without distortion, as the cameras give their pictures: 500 * 60 / 20 = 1500 mm.
std::string raw_rig(const test::TempFolder& folder, const Case& size)
{
    const auto matrix = [](const char* name, int columns, const std::string& data) {
        return std::string(name) + ": !!opencv-matrix\n   rows: 3\n   cols: " + std::to_string(columns) +
               "\n   dt: d\n   data: [ " + data + " ]\n";
    };
    const std::string k = "500., 0., " + std::to_string((size.width - 1) / 2.0) + ", 0., 500., " +
                          std::to_string((size.height - 1) / 2.0) + ", 0., 0., 1.";
    return folder.write("rig.yaml", "%YAML:1.0\n---\nimage_width: " + std::to_string(size.width) +
                                        "\nimage_height: " + std::to_string(size.height) +
                                        "\nnear_mm: 1000\nfar_mm: 3000\n" + matrix("K1", 3, k) + matrix("K2", 3, k) +
                                        matrix("R", 3, "1., 0., 0., 0., 1., 0., 0., 0., 1.") +
                                        matrix("T", 1, "-60., 0., 0."));
}

TEST(Memory, ProcessOfARawPairThatFillsTheCloudStaysWithinItsPrediction)
{
    if (!measurable("Memory.ProcessOfARawPairThatFillsTheCloudStaysWithinItsPrediction"))
        return;
    for (const Case& size : {kWebcam, kWide}) {
        const test::TempFolder folder;
        const std::string pair =
            textured_ppm(folder, "left.ppm", size, 0) + " " + textured_ppm(folder, "right.ppm", size, 20);
        const auto report = report_of("process " + pair + " --rig " + raw_rig(folder, size) + " -o " +
                                      folder.path("cloud.drc") + " --window 5 --threads 2");
        ASSERT_TRUE(report.contains("points"));
        EXPECT_EQ(report["rectified"], true);
        const double filled = report["points"].get<double>() / (static_cast<double>(size.width) * size.height);
        EXPECT_GT(filled, 0.95) << "the cloud is not full";
        const double predicted = predicted_bytes({size.width, size.height, report["disparities"], 0},
                                                 " --window 5 --threads 2", "process_total_bytes");
        const double real = report["peak_memory_bytes"];
        const double compressor = report["compressor_peak_bytes"];
        // The compressor is lent what the worst cloud needs, and touches less of it for a wall.
        const auto lent = static_cast<double>(
            encode_heap_bytes(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height)));
        const double for_this_cloud = predicted - lent + compressor;
        std::printf(
            "process, raw, %d x %d, %.1f %% of the pixels are points: at most %.1f MiB, for this cloud %.1f MiB, "
            "real %.1f MiB\n",
            size.width, size.height, 100 * filled, predicted / kMiB, for_this_cloud / kMiB, real / kMiB);
        EXPECT_GE(lent, compressor);
        EXPECT_GE(for_this_cloud, real) << "a prediction that is too low is a promise broken in the field";
        EXPECT_LE(for_this_cloud, 1.1 * real);
    }
}

TEST(Memory, TheBudgetsHoldAtTheFullWindow)
{
    if (!measurable("Memory.TheBudgetsHoldAtTheFullWindow"))
        return;
    for (const Case& size : {kWebcam, kWide})
        for (const char* method : {"paper", "fast", "standard", "best"})
            for (const int threads : {1, 2, 4}) {
                const double bytes = predicted_bytes(size,
                                                     std::string(" --window 35 --dense --method ") + method +
                                                         " --threads " + std::to_string(threads),
                                                     "total_bytes");
                std::printf("%d x %d x %d, %s, %d threads: %.1f MiB of %.0f\n", size.width, size.height,
                            size.disparities, method, threads, bytes / kMiB, size.limit_mib);
                EXPECT_GT(bytes, 0);
                EXPECT_LE(bytes, size.limit_mib * kMiB) << method;
            }
}

} // namespace
} // namespace dicot
