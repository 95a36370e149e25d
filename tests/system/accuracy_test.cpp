// dicot accuracy from files: walls at distances that follow from their shift, and what is refused.
#include "csv_lines.h"
#include "flat_pair.h"
#include "raw_wall.h"
#include "temp_folder.h"
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace dicot {
namespace {

using test::TempFolder;
using test::ToolRun;

ToolRun accuracy(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " accuracy " + words + " --window 9");
}

nlohmann::json report_of(const std::string& words)
{
    const ToolRun run = accuracy(words + " --json");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return run.exit_code == 0 ? nlohmann::json::parse(run.output) : nlohmann::json::object();
}

/// Walls at 24000 mm px / shift: focal length 400 px, baseline 60 mm.
struct Walls
{
    static constexpr double kDepthPxMm = 400 * 60;
    TempFolder folder;
    std::string rig = folder.path("rig.yaml");
    std::string pairs = folder.path("walls");

    explicit Walls(const std::vector<int>& shifts = {48, 40, 30, 24})
    {
        std::filesystem::create_directory(pairs);
        for (const int shift : shifts) {
            const test::FlatPair wall{.width = 240, .height = 80, .focal_px = 400, .shift_px = shift};
            const std::string name = "walls/wall_" + std::to_string(static_cast<int>(kDepthPxMm) / shift);
            folder.write(name + "_left.ppm", wall.side(false));
            folder.write(name + "_right.ppm", wall.side(true));
            folder.write("rig.yaml", wall.rig(400, 1100));
        }
    }
    std::string words() const { return pairs + " --rig " + rig; }
};

TEST(Accuracy, NamesTellTheDistancesAndWallsStandThere)
{
    const Walls walls;
    const auto report = report_of(walls.words());
    ASSERT_EQ(report["targets"].size(), 4u);
    EXPECT_NEAR(report["baseline_mm"], 60, 1e-9);
    const double depth_px_mm = report["focal_px"].get<double>() * 60;
    double before = 0;
    for (const auto& wall : report["targets"]) {
        const double distance = wall["distance_mm"];
        EXPECT_GT(distance, before) << "from near to far";
        before = distance;
        EXPECT_NEAR(wall["bound_mm"], distance * distance / depth_px_mm * 0.5, 1e-6);
        EXPECT_LT(std::fabs(wall["error_mm"].get<double>()), 0.2 * wall["bound_mm"].get<double>()) << wall.dump();
        EXPECT_DOUBLE_EQ(wall["measured_mm"].get<double>() - distance, wall["error_mm"]);
        EXPECT_GT(wall["density"], 0.95);
        EXPECT_GT(wall["pixels"], 100);
    }
    EXPECT_EQ(report["under_bound"], 4);
    EXPECT_TRUE(report["table"].is_null());
}

TEST(Accuracy, ThePartAroundTheTargetGivesWhatTheWholePictureGives)
{
    const Walls walls({40});
    const auto part = report_of(walls.words()), whole = report_of(walls.words() + " --whole");
    EXPECT_EQ(part["targets"], whole["targets"]);
}

TEST(Accuracy, DistancesThatAreOffByTheSameAreToldAsThat)
{
    const Walls walls;
    walls.folder.write("walls/true.csv", std::string("name,distance_mm\n"
                                                     "wall_500,507\nwall_600,607\nwall_800,807\nwall_1000,1007\n"));
    const auto report = report_of(walls.words());
    EXPECT_EQ(report["trend"]["cause"], "constant") << report["trend"].dump();
    EXPECT_NEAR(report["trend"]["amount"], -7, 1);
    EXPECT_EQ(report["table"], walls.pairs + "/true.csv");
}

TEST(Accuracy, DistancesThatAreOffInProportionAreToldAsThat)
{
    const Walls walls;
    walls.folder.write("two_percent.csv", std::string("\"distance_mm\" , left,right\r\n"
                                                      "490,walls/wall_500_left.ppm,walls/wall_500_right.ppm\r\n\r\n"
                                                      "588,walls/wall_600_left.ppm,walls/wall_600_right.ppm\r\n"
                                                      "784,walls/wall_800_left.ppm,walls/wall_800_right.ppm\r\n"
                                                      "980,walls/wall_1000_left.ppm,walls/wall_1000_right.ppm\r\n"));
    const auto report = report_of(walls.words() + " --table " + walls.folder.path("two_percent.csv"));
    EXPECT_EQ(report["trend"]["cause"], "distance") << report["trend"].dump();
    EXPECT_NEAR(report["trend"]["amount"], 0.0204, 0.002);
    EXPECT_EQ(report["targets"][0]["name"], "walls/wall_500_left.ppm");
}

TEST(Accuracy, ASlantedTargetIsHeldAgainstItsPlaneAndSeenInTheLeftCamerasFrame)
{
    const test::RawWall wall;
    wall.folder.write("wall.csv",
                      std::string("left,right,distance_mm,normal_x,normal_y,normal_z,centre_x_mm,centre_y_mm,"
                                  "centre_z_mm\nleft.ppm,right.ppm,600,-0.25,0,1,0,0,600\n"));
    const auto report =
        report_of(wall.folder.path("") + " --rig " + wall.rig_path + " --box 100,60,120,60 --method standard");
    const auto& target = report["targets"][0];
    // A tenth of a pixel is 2.2 mm; held against its distance alone, the spread would be the wall's slope.
    EXPECT_LT(std::fabs(target["error_mm"].get<double>()), 1.5) << target.dump();
    EXPECT_LT(target["spread_mm"], 5);
    EXPECT_NEAR(target["pixels"].get<double>(), 120 * 60, 1500) << "rectification changes the size a little";
}

TEST(Accuracy, TheReportIsAPageAPlotAndATable)
{
    const Walls walls({48, 40});
    const std::string folder = walls.folder.path("report"), csv = walls.folder.path("out.csv");
    const ToolRun run = accuracy(walls.words() + " --report " + folder + " -o " + csv);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_NE(run.output.find("wall_600"), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("All 2 stay under the bound"), std::string::npos) << run.output;
    const auto text_of = [](const std::string& path) {
        const test::Bytes bytes = test::bytes_of(path);
        return std::string(bytes.begin(), bytes.end());
    };
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 3);
    const std::string page = text_of(folder + "/index.html"), plot = text_of(folder + "/accuracy.svg");
    EXPECT_NE(page.find("wall_500"), std::string::npos);
    EXPECT_NE(page.find("<svg"), std::string::npos);
    EXPECT_EQ(page.find("http"), std::string::npos) << "refers to something outside";
    EXPECT_NE(plot.find("xmlns="), std::string::npos) << "no browser shows it alone";
    EXPECT_EQ(text_of(csv), text_of(folder + "/accuracy.csv"));
    const auto lines = test::csv_lines(csv);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[1][0], "wall_600_left");
    EXPECT_EQ(lines[1][1], "600.000");
}

TEST(Accuracy, ATargetWithoutADepthIsNamedAndTheOthersAreMeasured)
{
    const Walls walls({48, 40});
    const test::Bytes head = test::bytes_of(walls.pairs + "/wall_600_left.ppm");
    walls.folder.write("walls/wall_600_left.ppm", test::Bytes(head.begin(), head.begin() + 400)); // cut short
    const std::string csv = walls.folder.path("table.csv");
    const ToolRun run = accuracy(walls.words() + " --json -o " + csv);
    EXPECT_EQ(run.exit_code, 65) << run.output;
    EXPECT_NE(run.output.find("1 of 2 targets gave no depth"), std::string::npos) << run.output;
    EXPECT_TRUE(std::filesystem::exists(csv));
    const std::size_t begin = run.output.find('{');
    ASSERT_NE(begin, std::string::npos) << run.output;
    const auto report = nlohmann::json::parse(run.output.substr(begin, run.output.rfind('}') + 1 - begin));
    EXPECT_EQ(report["measured"], 1);
    EXPECT_TRUE(report["targets"][1]["error_mm"].is_null());
    EXPECT_NE(report["targets"][1]["reason"].get<std::string>().find("wall_600_left.ppm"), std::string::npos);
}

TEST(Accuracy, WhatCannotBeMeasuredIsNamed)
{
    const Walls walls({40});
    const auto refused = [&](const std::string& words, int exit_code, const std::string& says) {
        const ToolRun run = accuracy(words);
        EXPECT_EQ(run.exit_code, exit_code) << words << "\n" << run.output;
        EXPECT_NE(run.output.find(says), std::string::npos) << words << "\n" << run.output;
        EXPECT_EQ(std::ranges::count(run.output, '\n'), 1) << run.output;
    };
    const std::string rig = " --rig " + walls.rig;
    refused(walls.folder.path("gone") + rig, 66, "gone");
    refused(walls.pairs + " --rig " + walls.folder.path("gone.yaml"), 66, "gone.yaml");
    const std::string page = walls.folder.path("page");
    refused(walls.pairs + " --rig " + walls.folder.path("gone.yaml") + " --report " + page, 66, "gone.yaml");
    EXPECT_FALSE(std::filesystem::exists(page));
    refused(walls.words() + " --report " + page + "/in/it", 73, "/in/it");
    refused(walls.words() + " --box 1,2,3", 64, "--box 1,2,3");
    refused(walls.words() + " --box 200,0,60,10", 64, "does not lie in");
    refused(walls.words() + " --far-mm 550", 64, "widen");
    refused(walls.words() + " --report " + walls.pairs, 64, "named twice");
    refused(walls.words() + " -o " + walls.pairs + "/out.csv", 64, "table of distances");
    refused(walls.words() + " --near-mm 900 --far-mm 700", 64, "makes no sense");
    walls.folder.write("walls/wall_600_left.ppm", test::FlatPair{.width = 120, .height = 80}.side(false));
    refused(walls.words(), 65, "a pair has one size");
    walls.folder.write("walls/wall_600_right.ppm", test::FlatPair{.width = 120, .height = 80}.side(true));
    refused(walls.words(), 65, "is for 240 x 80");
    walls.folder.write("walls/a.csv", std::string("name,distance_mm\nwall_600,six hundred\n"));
    refused(walls.words(), 65, "line 2: distance_mm is \"six hundred\"");
    walls.folder.write("walls/a.csv", std::string("name,distance_mm\nwall_700,700\n"));
    refused(walls.words(), 66, "\"wall_700\"");
    walls.folder.write("walls/b.csv", std::string("name,distance_mm\nwall_600,600\n"));
    refused(walls.words(), 64, "--table");
    const std::string other = walls.folder.path("other");
    std::filesystem::create_directory(other);
    walls.folder.write("other/wall_left.ppm", test::FlatPair{}.side(false));
    walls.folder.write("other/wall_right.ppm", test::FlatPair{}.side(true));
    refused(other + rig, 65, "tells no distance");
    walls.folder.write("other/some.csv", std::string("name,metres\nwall,0.6\n"));
    refused(other + rig, 65, "tells no distance");
    refused(other + rig + " --table " + walls.folder.path("other/some.csv"), 65, "distance_mm");
}

} // namespace
} // namespace dicot
