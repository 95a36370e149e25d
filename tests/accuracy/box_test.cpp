// A box at nineteen distances, measured by the program itself with a rig file that it made from boards: the depth
// experiment of the paper.
#include "temp_folder.h"
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

namespace dicot {
namespace {

const std::string kRigDev = std::string{DICOT_DATA_DIR} + "/rig-dev/";

bool data_there(const char* test)
{
    if (std::filesystem::exists(kRigDev + "box/gt_box.csv"))
        return true;
    std::printf("NOT RUN: %s: %sbox is not there\n", test, kRigDev.c_str());
    return false;
}

test::ToolRun dicot(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " " + words);
}

/// The rig as `dicot calibrate` finds it from both of its boards, made once.
const std::string& own_rig()
{
    static const test::TempFolder folder;
    static const std::string path = [] {
        const std::string boards = kRigDev + "calibration/";
        const test::ToolRun run =
            dicot("calibrate --images " + boards + "board10x10_41mm --squares 10x10 --square-mm 41 --images " + boards +
                  "board8x8_46mm --squares 8x8 --square-mm 46 -o " + folder.path("rig.yaml"));
        EXPECT_EQ(run.exit_code, 0) << run.output;
        return folder.path("rig.yaml");
    }();
    return path;
}

nlohmann::json measured(const std::string& set)
{
    const std::string report = std::string(DICOT_PICTURES_DIR) + "/" + set;
    std::filesystem::create_directories(report);
    const test::ToolRun run = dicot("accuracy " + kRigDev + set + " --rig " + own_rig() + " --json --report " + report);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    const auto found = nlohmann::json::parse(run.output);
    std::printf("  %-10s | true mm | error mm | eq. 21 mm | half within | 95 %% within | valued\n", set.c_str());
    for (const auto& t : found["targets"])
        if (t["error_mm"].is_number())
            std::printf("  %-10s | %7.0f | %+8.2f | %9.2f | %8.2f mm | %8.2f mm | %5.1f %%\n",
                        t["name"].get<std::string>().c_str(), t["distance_mm"].get<double>(),
                        t["error_mm"].get<double>(), t["bound_mm"].get<double>(), t["spread_mm"].get<double>(),
                        t["point_95_mm"].get<double>(), 100 * t["density"].get<double>());
    std::printf("  %s\n  %.1f s, %s/index.html\n", found["trend"]["words"].get<std::string>().c_str(),
                found["seconds"].get<double>(), report.c_str());
    return found;
}

TEST(Box, ItsFaceStandsWhereItStoodAtEveryDistance)
{
    if (!data_there("Box.ItsFaceStandsWhereItStoodAtEveryDistance"))
        return;
    const auto found = measured("box");
    ASSERT_EQ(found["targets"].size(), 19u);
    for (const auto& target : found["targets"]) {
        ASSERT_TRUE(target["error_mm"].is_number()) << target.dump();
        const double distance_mm = target["distance_mm"], error_mm = target["error_mm"];
        EXPECT_LE(std::fabs(error_mm), distance_mm <= 800 ? 1.0 : 3.0) << target["name"];
        EXPECT_LT(std::fabs(error_mm), target["bound_mm"].get<double>()) << target["name"];
        EXPECT_GE(target["density"].get<double>(), 0.95) << target["name"];
        if (distance_mm <= 800) { // of the paper: each single point
            EXPECT_LT(target["point_95_mm"].get<double>(), 5) << target["name"];
        }
    }
}

TEST(Box, AFaceThatIsTurnedStandsOnItsPlane)
{
    if (!data_there("Box.AFaceThatIsTurnedStandsOnItsPlane"))
        return;
    const auto found = measured("box_slanted");
    ASSERT_EQ(found["targets"].size(), 5u);
    for (const auto& target : found["targets"]) {
        ASSERT_TRUE(target["error_mm"].is_number()) << target.dump();
        EXPECT_LE(std::fabs(target["error_mm"].get<double>()), target["distance_mm"] <= 800 ? 1.0 : 3.0)
            << target["name"];
    }
}

} // namespace
} // namespace dicot
