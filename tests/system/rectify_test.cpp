// The program itself: raw pair in, rectified pair out; rigs to ROS and back.
#include "temp_folder.h"
#include "tool.h"

#include "dicot/rig/rig_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

namespace dicot {
namespace {

using test::Bytes;
using test::TempFolder;
using test::ToolRun;

ToolRun dicot(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " " + words);
}

/// A plain grey picture.
std::string picture(const TempFolder& folder, const std::string& name, int width, int height)
{
    const std::string head = "P5 " + std::to_string(width) + " " + std::to_string(height) + " 255\n";
    Bytes bytes(head.begin(), head.end());
    bytes.insert(bytes.end(), static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 90);
    return folder.write(name, bytes);
}

TEST(RectifyCommand, WritesThePairItsMaskAndItsRig)
{
    const TempFolder folder;
    const std::string pair = picture(folder, "l.pgm", 1280, 720) + " " + picture(folder, "r.pgm", 1280, 720);
    const std::string out = folder.path("flat");
    const ToolRun run = dicot("rectify " + pair + " --rig " DICOT_UNRECTIFIED_RIG " --proof -o " + out);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_NE(run.output.find("worst error"), std::string::npos);
    for (const char* name : {"left.png", "right.png", "mask.png", "proof.png"})
        EXPECT_EQ(dicot("info " + out + "/" + name).exit_code, 0) << name;
    const RigFile flat = read_rig_file((out + "/rig.yaml").c_str()).value();
    EXPECT_NEAR(geometry_of(flat, "rig.yaml").value().baseline_mm, 85.0, 1e-3); // of the rendered rig
    EXPECT_FALSE(flat.left.intrinsic) << "the rectified pair would be rectified again";
}

TEST(RectifyCommand, APictureOfAnotherSizeIsRefusedAndNothingIsWritten)
{
    const TempFolder folder;
    const std::string pair = picture(folder, "l.pgm", 640, 360) + " " + picture(folder, "r.pgm", 640, 360);
    const ToolRun run = dicot("rectify " + pair + " --rig " DICOT_UNRECTIFIED_RIG " -o " + folder.path("flat"));
    EXPECT_EQ(run.exit_code, 65);
    EXPECT_NE(run.output.find("640 x 360"), std::string::npos) << run.output;
    EXPECT_FALSE(std::filesystem::exists(folder.path("flat")));
}

TEST(RectifyCommand, NeverWritesOverWhatItReads)
{
    const TempFolder folder;
    const std::string left = picture(folder, "left.png", 1280, 720), right = picture(folder, "r.pgm", 1280, 720);
    std::filesystem::copy_file(DICOT_UNRECTIFIED_RIG, folder.path("rig.yaml"));
    const Bytes rig = test::bytes_of(folder.path("rig.yaml")), seen = test::bytes_of(left);
    std::filesystem::create_directory(folder.path("other"));
    std::filesystem::copy_file(DICOT_UNRECTIFIED_RIG, folder.path("other/rig.yaml"));
    for (const std::string& words :
         {left + " " + right + " --rig " + folder.path("other/rig.yaml") + " -o " + folder.path(""),
          left + " " + right + " --rig " + folder.path("rig.yaml") + " -o " + folder.path("")}) {
        const ToolRun run = dicot("rectify " + words);
        EXPECT_EQ(run.exit_code, 64) << run.output;
    }
    EXPECT_EQ(test::bytes_of(folder.path("rig.yaml")), rig);
    EXPECT_EQ(test::bytes_of(left), seen);
}

TEST(RigCommand, RosAndBackIsEqualTo1e9)
{
    const TempFolder folder;
    const std::string ros = folder.path("ros"), first = folder.path("a.yaml"), second = folder.path("b.yaml");
    std::filesystem::create_directory(ros);
    ASSERT_EQ(dicot("rig convert " DICOT_UNRECTIFIED_RIG " --ros " + ros + " --opencv " + first).exit_code, 0);
    ASSERT_EQ(dicot("rig convert " + ros + " --opencv " + second).exit_code, 0);
    const RigFile a = read_rig_file(first.c_str()).value(), b = read_rig_file(second.c_str()).value();
    const auto same = [](const auto& x, const auto& y) {
        for (std::size_t i = 0; i < x.size(); ++i)
            for (std::size_t j = 0; j < x[i].size(); ++j)
                EXPECT_NEAR(x[i][j], y[i][j], 1e-9 * std::max(1.0, std::fabs(x[i][j])));
    };
    same(*a.left.intrinsic, *b.left.intrinsic);
    same(*a.right.intrinsic, *b.right.intrinsic);
    same(*a.left.rectifying, *b.left.rectifying);
    same(*a.right.projection, *b.right.projection);
    same(*a.rotation, *b.rotation);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR((*a.translation_mm)[i], (*b.translation_mm)[i], 1e-9 * 85);
    EXPECT_EQ(a.left.distortion->at, b.left.distortion->at);
    const Bytes right = test::bytes_of(ros + "/right.yaml");
    const std::string text(right.begin(), right.end());
    EXPECT_NE(text.find(", -66.7"), std::string::npos) << "metres: -784.9 px x 0.085 m";
}

} // namespace
} // namespace dicot
