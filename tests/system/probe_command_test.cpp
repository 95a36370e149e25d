// dicot probe on this machine, whatever is plugged into it.
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace dicot {
namespace {

TEST(ProbeCommand, TellsTheCamerasOrWhyThereIsNone)
{
    const test::ToolRun told = test::run(std::string{DICOT_PROGRAM} + " probe");
    if (told.exit_code == 0) {
        EXPECT_NE(told.output.find("driver "), std::string::npos) << told.output;
        return;
    }
    EXPECT_EQ(told.exit_code, 69) << told.output;
    EXPECT_EQ(told.output.rfind("dicot: ", 0), 0u) << told.output;
    EXPECT_EQ(told.output.find('\n'), told.output.size() - 1) << "one sentence: " << told.output;
    EXPECT_NE(told.output.find("group video"), std::string::npos) << told.output;
    EXPECT_NE(told.output.find("recorded pairs"), std::string::npos) << told.output;
}

TEST(ProbeCommand, JsonListsTheCamerasThoughThereAreNone)
{
    const test::ToolRun told = test::run(std::string{"( "} + DICOT_PROGRAM + " probe --json 2>/dev/null )");
    const nlohmann::json report = nlohmann::json::parse(told.output, nullptr, false);
    ASSERT_TRUE(report.is_object()) << told.output;
    ASSERT_TRUE(report["cameras"].is_array()) << told.output;
    EXPECT_EQ(told.exit_code, report["cameras"].empty() ? 69 : 0) << told.output;
    EXPECT_EQ(report["problem"].is_string(), report["cameras"].empty()) << told.output;
}

} // namespace
} // namespace dicot
