// Rigs of other programs through `dicot rig`.
#include "temp_folder.h"
#include "tool.h"

#include "dicot/rig/rig_file.h"
#include "dicot/rig/rig_id.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace dicot {
namespace {

using test::TempFolder;
using test::ToolRun;

ToolRun dicot(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " " + words);
}

std::string matrix(const std::string& key, int rows, int cols, const std::string& data)
{
    return key + ": !!opencv-matrix\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(cols) +
           "\n   dt: d\n   data: [ " + data + " ]\n";
}

/// What OpenCV's stereo_calib writes; lengths in squares of 30 mm.
void write_sample(const TempFolder& folder)
{
    std::filesystem::create_directory(folder.path("sample"));
    folder.write("sample/intrinsics.yml",
                 "%YAML:1.0\n---\n" + matrix("M1", 3, 3, "533.5, 0., 342.5, 0., 533.6, 234.75, 0., 0., 1.") +
                     matrix("D1", 1, 14, "-0.28, 0.1, 0.001, -0.0003, 0., 0., 0., 0.02, 0., 0., 0., 0., 0., 0.") +
                     matrix("M2", 3, 3, "536.9, 0., 327.4, 0., 536.5, 250., 0., 0., 1.") +
                     matrix("D2", 1, 14, "-0.29, 0.1, -6e-4, 1e-4, 0., 0., 0., 0.02, 0., 0., 0., 0., 0., 0."));
    folder.write("sample/extrinsics.yml", "%YAML:1.0\n---\n" + matrix("R", 3, 3, "1., 0., 0., 0., 1., 0., 0., 0., 1.") +
                                              matrix("T", 3, 1, "-3.25, 0., 0."));
}

TEST(RigCommand, ASampleOfStereoCalibBecomesARig)
{
    const TempFolder folder;
    write_sample(folder);
    const std::string made = folder.path("rig.yaml");
    const ToolRun run = dicot("rig convert " + folder.path("sample") + " --size 640x480 --unit-mm 30 --opencv " + made);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const RigFile rig = read_rig_file(made.c_str()).value();
    EXPECT_EQ(rig.width, 640);
    EXPECT_EQ(rig.height, 480);
    EXPECT_EQ((*rig.translation_mm)[0], -97.5);
    EXPECT_NEAR(geometry_of(rig, "rig.yaml").value().baseline_mm, 97.5, 1e-9);
    EXPECT_STREQ(rig.id, rig_id_of(rig).data()) << "it has a name from now on";
}

TEST(RigCommand, WhatASampleDoesNotSayIsAskedFor)
{
    const TempFolder folder;
    write_sample(folder);
    const std::string source = folder.path("sample"), made = folder.path("rig.yaml");
    const auto expect = [&](const std::string& words, int exit_code, const char* says) {
        const ToolRun run = dicot("rig convert " + words + " --opencv " + made);
        EXPECT_EQ(run.exit_code, exit_code) << words;
        EXPECT_NE(run.output.find(says), std::string::npos) << run.output;
        EXPECT_FALSE(std::filesystem::exists(made));
    };
    expect(source, 65, "--size");
    for (const char* size : {"640", "640x", "x480", "640x480x3", "-640x480", "0x0", "640X480", "99999x1", "1e2x480"})
        expect(source + " --size " + size, 64, "as 640x480");
    for (const char* unit : {"0", "-1", "nan", "inf"})
        expect(source + " --size 640x480 --unit-mm " + unit, 64, "mm one unit");
    expect(DICOT_UNRECTIFIED_RIG " --size 640x480", 65, "leave the size to the file");
    std::filesystem::remove(source + "/extrinsics.yml");
    expect(source + " --size 640x480", 66, "extrinsics.yml");
}

TEST(RigCommand, HintsAboutACameraInfoPairAreRefused)
{
    const TempFolder folder;
    std::filesystem::create_directory(folder.path("ros"));
    ASSERT_EQ(dicot("rig convert " DICOT_UNRECTIFIED_RIG " --ros " + folder.path("ros")).exit_code, 0);
    const ToolRun run =
        dicot("rig convert " + folder.path("ros") + " --unit-mm 1000 --opencv " + folder.path("rig.yaml"));
    EXPECT_EQ(run.exit_code, 64);
    EXPECT_NE(run.output.find("leave --size and --unit-mm out"), std::string::npos) << run.output;
}

TEST(RigCommand, OneCameraOfOpenCvsSampleIsShown)
{
    const std::string path = std::string{DICOT_DATA_DIR} + "/calibration-opencv/left_intrinsics.yml";
    if (!std::filesystem::exists(path)) {
        std::printf("NOT RUN: %s is not there\n", path.c_str());
        return;
    }
    const ToolRun run = dicot("rig show " + path);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_NE(run.output.find("535.916"), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("640 x 480"), std::string::npos) << run.output;
    EXPECT_EQ(run.output.find("nan"), std::string::npos) << run.output;
}

TEST(RigCommand, AnEmptyFileIsRefusedWithASentence)
{
    const TempFolder folder;
    const std::string empty = folder.write("rig.yaml", std::string{});
    for (const std::string& words : {"rig show " + empty, "rig tables " + empty, "info " + empty}) {
        const ToolRun run = dicot(words);
        EXPECT_EQ(run.exit_code, 65) << words << "\n" << run.output;
        EXPECT_NE(run.output.find("rig.yaml"), std::string::npos) << run.output;
    }
    write_sample(folder);
    folder.write("sample/intrinsics.yml", std::string{});
    EXPECT_EQ(dicot("rig show " + folder.path("sample")).exit_code, 65);
    std::filesystem::create_directory(folder.path("ros"));
    ASSERT_EQ(dicot("rig convert " DICOT_UNRECTIFIED_RIG " --ros " + folder.path("ros")).exit_code, 0);
    folder.write("ros/right.yaml", std::string{});
    EXPECT_EQ(dicot("rig show " + folder.path("ros")).exit_code, 65);
}

TEST(RigCommand, NoOutputIsItsOwnSource)
{
    const TempFolder folder;
    std::filesystem::create_directory(folder.path("ros"));
    ASSERT_EQ(dicot("rig convert " DICOT_UNRECTIFIED_RIG " --ros " + folder.path("ros")).exit_code, 0);
    const test::Bytes before = test::bytes_of(folder.path("ros/left.yaml"));
    for (const std::string& output : {"--opencv " + folder.path("ros/left.yaml"), "--ros " + folder.path("ros")})
        EXPECT_EQ(dicot("rig convert " + folder.path("ros") + " " + output).exit_code, 64) << output;
    EXPECT_EQ(test::bytes_of(folder.path("ros/left.yaml")), before);
}

TEST(RigCommand, NumbersThatWereChangedByHandGetTheirOwnId)
{
    const TempFolder folder;
    const std::string path = folder.path("rig.yaml");
    RigFile rig = read_rig_file(DICOT_UNRECTIFIED_RIG).value();
    set_id(rig);
    const std::string named = rig.id;
    (*rig.left.intrinsic)[0][0] += 1;
    ASSERT_TRUE(write_rig_file(path.c_str(), rig).ok());
    const ToolRun run = dicot("rig show " + path);
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.output.find("changed after it was named " + named), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("id " + std::string(rig_id_of(rig).data())), std::string::npos) << run.output;
}

} // namespace
} // namespace dicot
