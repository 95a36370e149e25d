// dicot schedule: what it lists, and what it refuses.
#include "temp_folder.h"
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace dicot {
namespace {

using nlohmann::json;

test::ToolRun schedule(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " schedule " + words);
}

constexpr const char* kBerlin = "[schedule]\ntimezone = 'CET-1CEST,M3.5.0,M10.5.0/3'\nat = ['02:30']\nevery = '6h'\n"
                                "from = '06:00'\nuntil = '18:00'\nlate_min = 7\n";

TEST(ScheduleCommand, ListsLocalTimeOffsetUtcAndWhy)
{
    const test::TempFolder folder;
    const std::string file = folder.write("a.toml", kBerlin);
    const test::ToolRun told = schedule("--from 2026-03-28T18:00 --next 3 --config " + file);
    EXPECT_EQ(told.exit_code, 0);
    EXPECT_EQ(told.output,
              "local time of CET-1CEST,M3.5.0,M10.5.0/3; a snapshot that could not begin within 7 min is missed\n\n"
              "local time           offset  UTC                   why\n"
              "2026-03-29 03:30:00  +02:00  2026-03-29T01:30:00Z  02:30\n"
              "2026-03-29 06:00:00  +02:00  2026-03-29T04:00:00Z  every 6h\n"
              "2026-03-29 12:00:00  +02:00  2026-03-29T10:00:00Z  every 6h\n");
}

TEST(ScheduleCommand, ASlotThatIsDueAtTheGivenTimeIsListed)
{
    const test::TempFolder folder;
    const std::string file = folder.write("a.toml", kBerlin);
    const json report =
        json::parse(schedule("--json --next 2 --from 2026-10-25T00:30:00 --config " + file).output, nullptr, false);
    ASSERT_TRUE(report.is_object());
    EXPECT_EQ(report["timezone"], "CET-1CEST,M3.5.0,M10.5.0/3");
    EXPECT_EQ(report["late_min"], 7);
    EXPECT_EQ(report["from"], "2026-10-25T00:30:00Z");
    ASSERT_EQ(report["slots"].size(), 2U);
    EXPECT_EQ(report["slots"][0],
              (json{{"due", "2026-10-25T00:30:00Z"}, {"local", "2026-10-25T02:30:00+02:00"}, {"why", "02:30"}}));
    EXPECT_EQ(report["slots"][1],
              (json{{"due", "2026-10-25T05:00:00Z"}, {"local", "2026-10-25T06:00:00+01:00"}, {"why", "every 6h"}}));
}

TEST(ScheduleCommand, WithoutTimesItSaysSo)
{
    const test::TempFolder folder;
    const std::string file = folder.write("a.toml", "[schedule]\n");
    const test::ToolRun told = schedule("--config " + file);
    EXPECT_EQ(told.exit_code, 0);
    EXPECT_EQ(told.output.rfind("no snapshot is due: ", 0), 0U) << told.output;
    EXPECT_EQ(json::parse(schedule("--json --config " + file).output, nullptr, false)["slots"], json::array());
}

TEST(ScheduleCommand, WhereTheSunNeverRisesItSaysSo)
{
    const test::TempFolder folder;
    const std::string file =
        folder.write("a.toml", "[schedule]\nat = ['sunrise']\nlatitude = 90\nlongitude = 0\ntimezone = 'UTC'\n");
    const test::ToolRun told = schedule("--config " + file);
    EXPECT_EQ(told.exit_code, 0);
    EXPECT_NE(told.output.find("the sun neither rises nor sets"), std::string::npos) << told.output;
}

TEST(ScheduleCommand, WrongWordsEndWithOneSentence)
{
    const test::TempFolder folder;
    const std::string file = folder.write("a.toml", "[schedule]\ntimezone = 'Mars'\n");
    for (const auto& [words, code] : {std::pair{"--config " + file, 78}, std::pair{std::string{"--from noon"}, 64},
                                      std::pair{std::string{"--next 0"}, 64}, std::pair{std::string{"--next x"}, 64}}) {
        const test::ToolRun told = schedule(words);
        EXPECT_EQ(told.exit_code, code) << words;
        EXPECT_EQ(told.output.rfind("dicot: ", 0), 0U) << told.output;
        EXPECT_EQ(told.output.find('\n'), told.output.size() - 1) << "one sentence: " << told.output;
    }
}

} // namespace
} // namespace dicot
