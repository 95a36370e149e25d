// dicot evaluate from files: the words of the command line and the two forms of a map.
#include "picture_bytes.h"
#include "temp_folder.h"
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace dicot {
namespace {

using test::Bytes;
using test::PngFile;
using test::ToolRun;

constexpr float kNone = std::numeric_limits<float>::infinity();

ToolRun evaluate(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " evaluate " + words);
}

/// One row of a PFM.
Bytes pfm_row(const std::vector<float>& values)
{
    const std::string head = "Pf\n" + std::to_string(values.size()) + " 1\n-1.0\n";
    Bytes file(head.begin(), head.end());
    file.resize(head.size() + values.size() * sizeof(float));
    std::memcpy(file.data() + head.size(), values.data(), values.size() * sizeof(float));
    return file;
}

double bad_percent(const nlohmann::json& report, double threshold)
{
    for (const auto& entry : report["bad"])
        if (entry["threshold_px"] == threshold)
            return entry["percent"];
    return -1;
}

struct Files
{
    test::TempFolder folder;
    std::string map = folder.write("map.pfm", pfm_row({10, 13, kNone, 7}));
    // Scale 4: 10, 10, 10 and unknown.
    std::string truth =
        folder.write("truth.png", PngFile{.width = 4, .colour_type = 0, .raster = {0, 40, 40, 40, 0}}.bytes());
};

TEST(Evaluate, AMapMeetsAScaledTruth)
{
    const Files files;
    const ToolRun run = evaluate(files.map + " " + files.truth + " --scale 4 --json");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto report = nlohmann::json::parse(run.output);
    EXPECT_EQ(report["judged_pixels"], 3);
    EXPECT_NEAR(report["density"], 2.0 / 3, 1e-12);
    EXPECT_NEAR(bad_percent(report, 2), 200.0 / 3, 1e-9);
    EXPECT_NEAR(bad_percent(report, 4), 100.0 / 3, 1e-9);
    EXPECT_EQ(report["bad"][2]["percent_of_valued"], 50) << "13 for 10, beside 10 for 10";
    EXPECT_DOUBLE_EQ(report["mean_error_px"], 1.5);
    EXPECT_NEAR(report["rms_error_px"], 2.1213203435596424, 1e-12);
}

TEST(Evaluate, TheMaskChoosesThePixels)
{
    const Files files;
    const std::string mask =
        files.folder.write("mask.png", PngFile{.width = 4, .colour_type = 0, .raster = {0, 255, 128, 0, 255}}.bytes());
    const ToolRun run = evaluate(files.map + " " + files.truth + " --scale 4 --json --mask " + mask);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_EQ(nlohmann::json::parse(run.output)["judged_pixels"], 1);
}

TEST(Evaluate, BothFormsOfOurMapsAreJudgedAlike)
{
    const Files files;
    const std::string png = files.folder.write(
        "map.png", PngFile{.width = 4, .bits = 16, .colour_type = 0, .raster = {0, 10, 0, 13, 0, 0, 0, 7, 0}}.bytes());
    auto from_pfm = nlohmann::json::parse(evaluate(files.map + " " + files.truth + " --scale 4 --json").output);
    auto from_png = nlohmann::json::parse(evaluate(png + " " + files.truth + " --scale 4 --json").output);
    from_pfm.erase("map");
    from_png.erase("map");
    EXPECT_EQ(from_pfm, from_png);
}

TEST(Evaluate, WithoutAnyDisparityThereIsNoMeanError)
{
    const Files files;
    const std::string none = files.folder.write("none.pfm", pfm_row({kNone, kNone, kNone, kNone}));
    const auto report = nlohmann::json::parse(evaluate(none + " " + files.truth + " --scale 4 --json").output);
    EXPECT_EQ(report["density"], 0);
    EXPECT_TRUE(report["mean_error_px"].is_null());
    EXPECT_TRUE(report["rms_error_px"].is_null());
    EXPECT_TRUE(report["bad"][0]["percent_of_valued"].is_null());
    EXPECT_EQ(bad_percent(report, 4), 100);
}

TEST(Evaluate, WhatCannotBeJudgedIsNamed)
{
    const Files files;
    const auto refused = [](const ToolRun& run, int exit_code, const std::string& says) {
        EXPECT_EQ(run.exit_code, exit_code) << run.output;
        EXPECT_NE(run.output.find(says), std::string::npos) << run.output;
    };
    const std::string small = files.folder.write("small.pfm", pfm_row({1, 2, 3}));
    const std::string unknown = files.folder.write("unknown.pfm", pfm_row({kNone, kNone, kNone, kNone}));
    refused(evaluate(files.folder.path("gone.pfm") + " " + files.truth), 66, "gone.pfm");
    refused(evaluate(files.map + " " + files.folder.path("gone.png")), 66, "gone.png");
    refused(evaluate(files.map + " " + small), 65, "small.pfm is 3 x 1");
    refused(evaluate(files.truth + " " + files.truth), 65, "has 8 bits");
    refused(evaluate(files.map + " " + unknown), 65, "no pixel can be judged");
    refused(evaluate(files.map + " " + files.truth + " --scale 0"), 64, "--scale");
}

} // namespace
} // namespace dicot
