// What dicot run really takes, beside what dicot memory says that it will take.
#include "flat_pair.h"
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>

namespace dicot {
namespace {

constexpr double kMiB = 1 << 20;

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

constexpr const char* kSchedule = "[schedule]\nevery = \"1h\"\n";

nlohmann::json budget_of(const std::string& config)
{
    const test::ToolRun run = test::run(std::string{DICOT_PROGRAM} + " memory --json --config " + config);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return run.exit_code == 0 ? nlohmann::json::parse(run.output) : nlohmann::json::object();
}

std::string rehearse(const std::string& config, int slots)
{
    return std::string{DICOT_PROGRAM} + " run --config " + config + " --rehearse " + std::to_string(slots) +
           " --from 2026-06-01T06:30:00Z";
}

nlohmann::json record_of_first(const test::TempFolder& folder)
{
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path("out")))
        if (entry.path().filename() == "record.json") {
            std::ifstream file(entry.path());
            return nlohmann::json::parse(file);
        }
    ADD_FAILURE() << "no record";
    return {};
}

struct Case
{
    test::FlatPair pair;
    int disparities;
    double limit_mib; ///< of the whole process, with everything in
};
const Case kWebcam{{640, 480, 500, 20}, 64, 64};
const Case kWide{{1280, 720, 500, 20}, 128, 112};

/// The search range begins at 9 px.
std::string write(const Case& one, const test::TempFolder& folder, const std::string& more = "")
{
    const double pixels_mm = one.pair.focal_px * 60.0;
    return one.pair.write(folder, pixels_mm / (one.disparities + 7), pixels_mm / 9.1, kSchedule + more);
}

void compare(const Case& one)
{
    const test::TempFolder folder;
    const std::string config = write(one, folder);
    const auto budget = budget_of(config);
    ASSERT_EQ(budget.value("disparities", 0), one.disparities);
    const auto predicted = budget["run_resident_bytes"].get<double>();

    const auto address = budget["run_address_bytes"].get<long long>();
    const test::ToolRun run = test::run("prlimit --as=" + std::to_string(address) + " " + rehearse(config, 1));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto record = record_of_first(folder);
    ASSERT_EQ(record["outcome"], "done") << record["reason"];
    const double pixels = static_cast<double>(one.pair.width) * one.pair.height;
    EXPECT_GT(record["cloud"]["points"].get<double>(), 0.9 * pixels) << "the cloud is not full";

    // The compressor is lent what the worst cloud needs, and touches less of it for a wall.
    const auto real = record["memory"]["peak_resident_bytes"].get<double>();
    const auto compressor = record["cloud"]["compressor_peak_bytes"].get<double>();
    const auto match = budget["match_bytes"].get<double>();
    const double stages =
        std::max({budget["compressor_bytes"].get<double>(), match, budget["preview_bytes"].get<double>()});
    const double for_this_cloud = predicted - stages + std::max(compressor, match);
    std::printf("run, %d x %d x %d: at most %.1f MiB, for this cloud %.1f MiB, real %.1f MiB; address space %.1f MiB\n",
                one.pair.width, one.pair.height, one.disparities, predicted / kMiB, for_this_cloud / kMiB, real / kMiB,
                static_cast<double>(address) / kMiB);
    EXPECT_GE(for_this_cloud, real) << "a prediction that is too low is a promise broken in the field";
    EXPECT_LE(for_this_cloud, 1.1 * real);
    EXPECT_LE(predicted, one.limit_mib * kMiB);
}

TEST(RunMemory, OfWebcamPicturesIsAsPredictedAndItRunsWithinItsAddressSpace)
{
    if (measurable("RunMemory.OfWebcamPicturesIsAsPredictedAndItRunsWithinItsAddressSpace"))
        compare(kWebcam);
}

TEST(RunMemory, OfWidePicturesIsAsPredictedAndItRunsWithinItsAddressSpace)
{
    if (measurable("RunMemory.OfWidePicturesIsAsPredictedAndItRunsWithinItsAddressSpace"))
        compare(kWide);
}

TEST(RunMemory, TheBudgetsHoldAtTheFullWindowAndForCamerasOnUsb)
{
    if (!measurable("RunMemory.TheBudgetsHoldAtTheFullWindowAndForCamerasOnUsb"))
        return;
    for (const Case& one : {kWebcam, kWide}) {
        const test::TempFolder folder;
        (void)write(one, folder);
        for (const char* method : {"standard", "best"}) {
            const std::string config =
                folder.write("usb.toml", "[cameras]\nwidth = " + std::to_string(one.pair.width) +
                                             "\nheight = " + std::to_string(one.pair.height) +
                                             "\n[rig]\nfile = \"rig.yaml\"\n[matching]\nthreads = 2\nwindow = 35\n"
                                             "method = \"" +
                                             method + "\"\n");
            const auto budget = budget_of(config);
            const auto bytes = budget.value("run_resident_bytes", 0.0);
            std::printf("%d x %d x %d on USB, %s, window 35: %.1f MiB of %.0f\n", one.pair.width, one.pair.height,
                        one.disparities, method, bytes / kMiB, one.limit_mib);
            EXPECT_GT(bytes, 0);
            EXPECT_LE(bytes, one.limit_mib * kMiB);
        }
    }
}

TEST(RunMemory, AConfigurationThatTakesMoreThanItMayIsRefusedAtTheStart)
{
    const test::TempFolder folder;
    const std::string config =
        test::FlatPair{}.write(folder, 500, 3000, std::string(kSchedule) + "[run]\nmost_memory_mib = 8\n");
    const test::ToolRun run = test::run(rehearse(config, 1));
    EXPECT_EQ(run.exit_code, 78) << run.output;
    EXPECT_NE(run.output.find("run.most_memory_mib allows 8"), std::string::npos) << run.output;
    const std::string enough =
        test::FlatPair{}.write(folder, 500, 3000, std::string(kSchedule) + "[run]\nmost_memory_mib = 800\n");
    EXPECT_EQ(test::run(rehearse(enough, 1)).exit_code, 0);
}

} // namespace
} // namespace dicot
