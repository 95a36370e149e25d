// dicot config: what it prints, and what it refuses.
#include "temp_folder.h"
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace dicot {
namespace {

using nlohmann::json;

test::ToolRun config(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " config " + words);
}

json value_of(const json& report, const char* section, const char* key)
{
    return report["sections"][section][key]["value"];
}

TEST(ConfigCommand, JsonTellsValueUnitDefaultAndOrigin)
{
    const test::TempFolder folder;
    const std::string file = folder.write("a.toml", "[rig]\nnear_mm = 250.5\n[cameras]\nleft = '1-2'\nwidth = 1280\n");
    const test::ToolRun told = config("--json --config " + file);
    ASSERT_EQ(told.exit_code, 0) << told.output;
    const json report = json::parse(told.output, nullptr, false);
    ASSERT_TRUE(report.is_object()) << told.output;
    EXPECT_EQ(report["file"], file);
    const json width = report["sections"]["cameras"]["width"];
    EXPECT_EQ(width["value"], 1280);
    EXPECT_EQ(width["default"], 640);
    EXPECT_EQ(width["unit"], "px");
    EXPECT_EQ(width["from"], "file");
    EXPECT_EQ(width["line"], 5);
    EXPECT_EQ(width["allowed"], "a whole number from 16 to 8192");
    const json height = report["sections"]["cameras"]["height"];
    EXPECT_EQ(height["value"], 480);
    EXPECT_EQ(height["from"], "default");
    EXPECT_TRUE(height["line"].is_null());
    EXPECT_EQ(value_of(report, "cameras", "left"), "port:1-2");
    EXPECT_EQ(value_of(report, "cameras", "formats"), (json{"YUYV", "NV12", "MJPEG", "GREY"}));
    EXPECT_EQ(value_of(report, "rig", "near_mm"), 250.5);
    EXPECT_TRUE(value_of(report, "rig", "far_mm").is_null());
    EXPECT_EQ(value_of(report, "exposure", "lock"), true);
}

TEST(ConfigCommand, WhatItPrintsIsAFileThatMeansTheSame)
{
    const test::TempFolder folder;
    const std::string file =
        folder.write("a.toml", "[cameras]\nleft = 'replay:pairs'\nright = 'replay:pairs'\n"
                               "replay_script = '''rate 5\ndrop 3'''\n[exposure]\nwarm_up_s = 0.75\n");
    const std::string printed = folder.path("printed.toml");
    ASSERT_EQ(config("--config " + file + " >" + printed).exit_code, 0);
    const json first = json::parse(config("--json --config " + file).output, nullptr, false);
    const json second = json::parse(config("--json --config " + printed).output, nullptr, false);
    ASSERT_TRUE(first.is_object() && second.is_object());
    int keys = 0;
    for (const auto& [section, members] : first["sections"].items())
        for (const auto& [key, member] : members.items()) {
            EXPECT_EQ(member["value"], value_of(second, section.c_str(), key.c_str())) << section << "." << key;
            ++keys;
        }
    EXPECT_GE(keys, 28);
    EXPECT_EQ(value_of(second, "cameras", "left"), "replay:" + folder.path("pairs"));
    EXPECT_EQ(value_of(second, "exposure", "warm_up_s"), 0.75);
}

TEST(ConfigCommand, TheSampleIsAFileThatChangesNothing)
{
    const test::TempFolder folder;
    const std::string sample = folder.path("sample.toml");
    ASSERT_EQ(config("--sample >" + sample).exit_code, 0);
    const std::string empty = folder.write("empty.toml", std::string{});
    json first = json::parse(config("--json --config " + sample).output, nullptr, false);
    json second = json::parse(config("--json --config " + empty).output, nullptr, false);
    ASSERT_TRUE(first.is_object() && second.is_object());
    EXPECT_EQ(first["sections"], second["sections"]);
}

TEST(ConfigCommand, AFaultIsOneSentenceWithFileAndLine)
{
    const test::TempFolder folder;
    const std::string file = folder.write("a.toml", "[burst]\nframes = 65\n");
    const test::ToolRun wrong = config("--config " + file);
    EXPECT_EQ(wrong.exit_code, 78);
    EXPECT_EQ(wrong.output, "dicot: " + file + ":2: [burst] frames is 65: give a whole number from 1 to 64 pairs\n");
    const test::ToolRun absent = config("--config " + folder.path("absent.toml"));
    EXPECT_EQ(absent.exit_code, 66) << absent.output;
    EXPECT_NE(absent.output.find("absent.toml"), std::string::npos) << absent.output;
    EXPECT_EQ(config("--sample --json").exit_code, 64);
    EXPECT_EQ(config("--sample --config " + file).exit_code, 64);
}

} // namespace
} // namespace dicot
