// The program itself on pictures as the cameras give them: rectified on the way, with tables built or loaded.
#include "ply_points.h"
#include "raw_wall.h"
#include "rendered_maps.h"
#include "temp_folder.h"
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace dicot {
namespace {

using test::RawWall;
using test::ToolRun;

ToolRun dicot(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " " + words);
}

/// Runs, and gives the report; what else was said stands before it.
nlohmann::json report_of(const std::string& words, std::string* said = nullptr)
{
    const ToolRun run = dicot(words + " --json");
    EXPECT_EQ(run.exit_code, 0) << words << "\n" << run.output;
    const std::size_t begin = run.output.find("{\n");
    if (said != nullptr)
        *said = run.output.substr(0, begin);
    return begin == std::string::npos ? nlohmann::json::object() : nlohmann::json::parse(run.output.substr(begin));
}

double median(std::vector<double> values)
{
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

TEST(RawPair, AWallStandsWhereItWasDrawn)
{
    const RawWall wall;
    const auto report = report_of(wall.process("cloud.drc") + " --ply " + wall.folder.path("cloud.ply"));
    EXPECT_EQ(report["rectified"], true);
    EXPECT_TRUE(report["tables"]["loaded_from"].is_null());
    const Rectification flat = rectify(wall.rig, kCrop, "rig.yaml").value();
    const Turn back = transposed(flat.left_rectifying);
    std::vector<double> off_mm;
    for (const Point3& point : test::ply_points_mm(wall.folder.path("cloud.ply")))
        off_mm.push_back(RawWall::beyond_mm(turned(back, point)));
    ASSERT_GT(off_mm.size(), 0.6 * wall.rig.width * wall.rig.height);
    const double bias = median(off_mm);
    for (double& off : off_mm)
        off = std::fabs(off);
    const double typical = median(off_mm);
    std::printf("drawn wall at %.0f mm: %zu points, depth error %.2f mm in the median, bias %.2f mm\n",
                RawWall::kDistanceMm, off_mm.size(), typical, bias);
    // A tenth of a pixel is 2.2 mm.
    EXPECT_LT(typical, 3.3);
    EXPECT_LT(std::fabs(bias), 0.7);
}

TEST(RawPair, StoredTablesGiveTheBytesOfBuiltOnes)
{
    const RawWall wall;
    ASSERT_TRUE(report_of(wall.process("built.drc"))["tables"]["loaded_from"].is_null());
    const auto stored = report_of("rig tables " + wall.rig_path);
    EXPECT_EQ(stored["output"], wall.maps_path);
    EXPECT_EQ(stored["bytes"], std::filesystem::file_size(wall.maps_path));
    EXPECT_LE(stored["left"]["worst_error_px"], 1.0 / 64);
    EXPECT_EQ(report_of(wall.process("loaded.drc"))["tables"]["loaded_from"], wall.maps_path);
    EXPECT_EQ(test::bytes_of(wall.folder.path("built.drc")), test::bytes_of(wall.folder.path("loaded.drc")));
    const auto again = report_of("rig tables " + wall.rig_path + " -o " + wall.folder.path("again.maps"));
    EXPECT_EQ(again["crc32"], stored["crc32"]);
    EXPECT_EQ(test::bytes_of(wall.maps_path), test::bytes_of(wall.folder.path("again.maps")));
}

/// The program says one sentence with `says`, works as if the file were not there, and leaves it as it is.
void expect_built_anew(const RawWall& wall, const std::string& says)
{
    const test::Bytes before = test::bytes_of(wall.maps_path);
    std::string said;
    const auto report = report_of(wall.process("anew.drc"), &said);
    EXPECT_TRUE(report["tables"]["loaded_from"].is_null());
    EXPECT_NE(said.find(says), std::string::npos) << said;
    EXPECT_NE(said.find("rig.maps"), std::string::npos) << said;
    EXPECT_NE(said.find("dicot rig tables"), std::string::npos) << "no remedy: " << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_EQ(test::bytes_of(wall.maps_path), before);
}

TEST(RawPair, DamagedOrForeignTablesAreNamedNotTrustedAndNotTouched)
{
    const RawWall wall;
    ASSERT_EQ(dicot(wall.process("right.drc")).exit_code, 0);
    ASSERT_EQ(dicot("rig tables " + wall.rig_path).exit_code, 0);
    const test::Bytes whole = test::bytes_of(wall.maps_path);
    const auto cloud_is_right = [&] {
        return test::bytes_of(wall.folder.path("anew.drc")) == test::bytes_of(wall.folder.path("right.drc"));
    };

    test::Bytes damaged = whole;
    damaged[damaged.size() / 2] ^= 1;
    wall.folder.write("rig.maps", damaged);
    expect_built_anew(wall, "damaged");
    EXPECT_TRUE(cloud_is_right());

    wall.folder.write("rig.maps", test::Bytes(whole.begin(), whole.begin() + 100));
    expect_built_anew(wall, "no rectification tables");
    EXPECT_TRUE(cloud_is_right());

    wall.folder.write("rig.maps", test::Bytes(1 << 20));
    expect_built_anew(wall, "larger than");
    EXPECT_TRUE(cloud_is_right());

    wall.folder.write("rig.maps", whole);
    StereoRig moved = wall.rig;
    moved.shift_mm.x -= 0.001;
    wall.write_rig(moved);
    expect_built_anew(wall, "another calibration");

    // What was asked for with other words is no fault and needs no sentence.
    wall.write_rig(wall.rig);
    const ToolRun kept =
        dicot("rectify " + wall.pair() + " --rig " + wall.rig_path + " --keep 1 -o " + wall.folder.path("flat"));
    EXPECT_EQ(kept.exit_code, 0);
    EXPECT_EQ(kept.output.find("warning"), std::string::npos) << kept.output;
    EXPECT_NE(kept.output.find("tables: built"), std::string::npos) << kept.output;
}

TEST(RawPair, ThePicturesOfRectifyAreTheSameFromStoredTables)
{
    const RawWall wall;
    const auto rectified = [&](const std::string& folder) {
        const ToolRun run =
            dicot("rectify " + wall.pair() + " --rig " + wall.rig_path + " -o " + wall.folder.path(folder));
        EXPECT_EQ(run.exit_code, 0) << run.output;
        return run.output;
    };
    EXPECT_NE(rectified("built").find("tables: built in"), std::string::npos);
    ASSERT_EQ(dicot("rig tables " + wall.rig_path).exit_code, 0);
    EXPECT_NE(rectified("loaded").find("tables: loaded from " + wall.maps_path), std::string::npos);
    for (const std::string name : {"left.png", "right.png", "mask.png", "rig.yaml"})
        EXPECT_EQ(test::bytes_of(wall.folder.path("built/" + name)), test::bytes_of(wall.folder.path("loaded/" + name)))
            << name;
}

TEST(RawPair, TablesOfWhatIsNoRigAreRefusedAndNothingIsWritten)
{
    const RawWall wall;
    const auto refused = [&](const std::string& words, int exit_code, const std::string& says) {
        const std::size_t files = wall.folder.files();
        const ToolRun run = dicot("rig tables " + words);
        EXPECT_EQ(run.exit_code, exit_code) << words << "\n" << run.output;
        EXPECT_NE(run.output.find(says), std::string::npos) << words << "\n" << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
        EXPECT_EQ(wall.folder.files(), files) << words;
    };
    refused(wall.folder.path("gone.yaml"), 66, "gone.yaml");
    refused(wall.left, 65, "left.ppm");
    refused(wall.rig_path + " -o " + wall.folder.path("rig.bin"), 64, ".maps");
    refused(wall.rig_path + " -o /nowhere/at/all/rig.maps", 73, "/nowhere/at/all");
    const std::string flat =
        wall.folder.write("flat.yaml", std::string("%YAML:1.0\n---\nimage_width: 320\nimage_height: 180\n"));
    refused(flat, 65, "K1, K2, R and T are needed");
    std::filesystem::create_symlink("/dev/full", wall.folder.path("full.maps"));
    refused(wall.rig_path + " -o " + wall.folder.path("full.maps"), 74, "disk is full");
}

} // namespace
} // namespace dicot
