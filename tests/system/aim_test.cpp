// dicot aim before recorded cameras whose pose is known, because their pictures are drawn.
#include "spotted_wall.h"
#include "temp_folder.h"
#include "tool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace dicot {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr int kWidth = 320, kHeight = 240;

/// One view of a wall that is moved to the left, and turned.
test::Bytes view(double shift_px, double clockwise_deg)
{
    static const test::SpottedWall wall(3);
    const std::string head = "P6 " + std::to_string(kWidth) + " " + std::to_string(kHeight) + " 255\n";
    test::Bytes file(head.begin(), head.end());
    const double turn = clockwise_deg / 57.29577951308232;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double u = x - kWidth / 2.0, v = y - kHeight / 2.0;
            const double level =
                wall.at(u * std::cos(turn) - v * std::sin(turn) + shift_px, u * std::sin(turn) + v * std::cos(turn));
            for (int channel = 0; channel < 3; ++channel)
                file.push_back(static_cast<std::uint8_t>(std::clamp(level, 0.0, 255.0)));
        }
    return file;
}

struct Rig
{
    test::TempFolder folder;
    std::string config;

    Rig(const test::Bytes& left, const test::Bytes& right, const std::string& more = "")
    {
        const std::string pairs = folder.path("pairs");
        std::filesystem::create_directory(pairs);
        folder.write("pairs/left_0.ppm", left);
        folder.write("pairs/right_0.ppm", right);
        config = folder.write("rig.toml", "[cameras]\nleft = \"replay:" + pairs + "\"\nright = \"replay:" + pairs +
                                              "\"\n" + more + "\n");
    }
    std::string command(const std::string& words) const
    {
        return std::string{DICOT_PROGRAM} + " aim --config " + config + " " + words;
    }
};

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

TEST(AimCommand, JsonTellsThePoseOfTheCameras)
{
    const Rig rig(view(0, 0), view(24, 2), "replay_script_left = \"skew_us 3000\"");
    const test::ToolRun run = test::run(rig.command("--seconds 1.5 --json"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const std::vector<std::string> lines = lines_of(run.output);
    ASSERT_GE(lines.size(), 2u) << run.output;
    const json first = json::parse(lines.front(), nullptr, false);
    ASSERT_TRUE(first.is_object()) << run.output;
    EXPECT_EQ(first["width"], kWidth);
    EXPECT_EQ(first["views"]["order"], "as named");
    EXPECT_NEAR(first["views"]["roll_deg"].get<double>(), 2, 0.2);
    EXPECT_NEAR(first["views"]["shift_px"].get<double>(), 24, 1);
    EXPECT_NEAR(first["views"]["overlap_percent"].get<double>(), 92, 1);
    EXPECT_EQ(first["skew_us"], -3000);
    EXPECT_THAT(first["advice"].get<std::vector<std::string>>(),
                testing::Contains(HasSubstr("turn the right camera 2.0 degrees counter-clockwise")));
    const json last = json::parse(lines.back(), nullptr, false);
    ASSERT_TRUE(last.is_object() && last.contains("summary")) << run.output;
    EXPECT_GE(last["summary"]["pairs"].get<int>(), 5);
}

TEST(AimCommand, SwappedCamerasAreNamed)
{
    const Rig rig(view(24, 0), view(0, 0));
    const test::ToolRun run = test::run(rig.command("--seconds 0.3"));
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("to do: left and right are swapped"));
}

TEST(AimCommand, CtrlCEndsWithASummary)
{
    const Rig rig(view(0, 0), view(24, 0));
    const test::ToolRun run = test::run("timeout --preserve-status --kill-after 20 -s INT 1 " + rig.command(""));
    EXPECT_EQ(run.exit_code, 0) << run.output;
    const std::vector<std::string> lines = lines_of(run.output);
    ASSERT_GE(lines.size(), 2u) << run.output;
    EXPECT_THAT(run.output, HasSubstr(" pairs in "));
    EXPECT_EQ(run.output.find('\033'), std::string::npos) << "escapes in a pipe";
}

TEST(AimCommand, ATerminalIsDrawnInPlaceAndNotOverfilled)
{
    DICOT_NEED_TOOL("script", "bsdutils");
    const Rig rig(view(0, 0), view(24, 4), "replay_script = \"rate 15; torn 2\"");
    const std::string in_terminal =
        "script -qec 'stty cols 60 rows 30; " + rig.command("--seconds 1.2") + "' /dev/null </dev/null";
    for (const bool colours : {true, false}) {
        const test::ToolRun run =
            test::run((colours ? "TERM=xterm NO_COLOR= " : "TERM=xterm NO_COLOR=1 ") + in_terminal);
        EXPECT_EQ(run.exit_code, 0) << run.output;
        EXPECT_EQ(run.output.find("\033[3") != std::string::npos, colours) << run.output;
        EXPECT_THAT(run.output, HasSubstr("1 torn"));
        int drawn = 0;
        for (std::string line : lines_of(run.output)) {
            std::string plain;
            for (std::size_t i = 0; i < line.size(); ++i) {
                if (line[i] == '\033')
                    i = line.find_first_of("AJKm", i);
                else if (line[i] != '\r')
                    plain += line[i];
            }
            EXPECT_LE(plain.size(), 60u) << plain;
            drawn += plain.starts_with("320 x 240 px") ? 1 : 0;
        }
        EXPECT_GE(drawn, 3) << run.output;
    }
}

TEST(AimCommand, RefusalsNameTheReason)
{
    const Rig rig(view(0, 0), view(24, 0));
    EXPECT_EQ(test::run(rig.command("--seconds 0")).exit_code, 64);
    const test::TempFolder folder;
    const std::string config =
        folder.write("rig.toml", "[cameras]\nleft = \"replay:/nowhere/at/all\"\nright = \"replay:/nowhere/at/all\"\n");
    const test::ToolRun run = test::run(std::string{DICOT_PROGRAM} + " aim --config " + config);
    EXPECT_EQ(run.exit_code, 66) << run.output;
    EXPECT_THAT(run.output, HasSubstr("/nowhere/at/all"));
}

TEST(AimCommand, AFullDiskIsAFailure)
{
    const Rig rig(view(0, 0), view(24, 0));
    const test::ToolRun run = test::run("( " + rig.command("--json --seconds 5") + " >/dev/full )");
    EXPECT_EQ(run.exit_code, 74) << run.output;
}

} // namespace
} // namespace dicot
