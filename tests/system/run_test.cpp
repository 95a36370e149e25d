// dicot run: slots by the schedule, a row for each, whatever happens.
#include "run_scene.h"

#include <gmock/gmock.h>

namespace dicot {
namespace {

using test::ToolRun;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::int64_t kHourUs = 3'600'000'000;

std::int64_t at(const char* text)
{
    return *parse_utc_text(text);
}

class Run : public test::RunOfOneBoard
{
protected:
    std::vector<std::string> dues() const
    {
        std::vector<std::string> dues;
        for (const Row& row : rows())
            dues.push_back(row.due);
        return dues;
    }
};

TEST_F(Run, TakesEachSlotOfTheSchedule)
{
    write_config("", "", "at = ['06:30', '12:00']\nevery = '4h'\nfrom = '08:00'\nuntil = '16:00'\n");
    const ToolRun run = rehearse(7, "2026-06-01T06:00:00Z");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_EQ(dues(), (std::vector<std::string>{"2026-06-01T06:30:00Z", "2026-06-01T08:00:00Z", "2026-06-01T12:00:00Z",
                                                "2026-06-01T16:00:00Z", "2026-06-02T06:30:00Z", "2026-06-02T08:00:00Z",
                                                "2026-06-02T12:00:00Z"}));
    for (const Row& row : rows())
        EXPECT_TRUE(row.done) << row.reason;
    EXPECT_EQ(dicot("verify").exit_code, 0);
    const nlohmann::json first = record(1);
    EXPECT_EQ(first["due"], "2026-06-01T06:30:00Z");
    EXPECT_EQ(first["plan"]["why"], "06:30");
    EXPECT_EQ(first["plan"]["woken"]["by"], "time");
    EXPECT_THAT(first["time"].get<std::string>(), StartsWith("2026-06-01T06:2"));
    EXPECT_THAT(first["shot"]["time"].get<std::string>(), StartsWith("2026-06-01T06:"));
    EXPECT_GT(first["cloud"]["points"], 1000);
}

TEST_F(Run, SlotsThatPassedWhileItWasNotRunningAreRowsWithAReason)
{
    ASSERT_EQ(rehearse(2, "2026-06-01T07:59:00Z").exit_code, 0);
    const ToolRun run = rehearse(1, "2026-06-02T09:00:00Z");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("11 slots were missed"));
    const std::vector<Row> all = rows();
    ASSERT_EQ(all.size(), 14U);
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].due,
                  utc_text(at("2026-06-01T08:00:00Z") + static_cast<std::int64_t>(i) * 2 * kHourUs).c_str());
        EXPECT_EQ(all[i].done, i < 2 || i == 13) << i;
        if (!all[i].done) {
            EXPECT_THAT(all[i].reason, HasSubstr("dicot was not running"));
        }
    }
    EXPECT_EQ(dicot("verify").exit_code, 0);
}

TEST_F(Run, ASlotThatIsLateByLittleIsTakenAndBySoMuchIsMissed)
{
    ASSERT_EQ(rehearse(1, "2026-06-01T07:59:00Z").exit_code, 0);
    ASSERT_EQ(rehearse(1, "2026-06-01T10:14:00Z").exit_code, 0);
    ASSERT_EQ(rehearse(1, "2026-06-01T12:16:00Z").exit_code, 0);
    const std::vector<Row> all = rows();
    ASSERT_EQ(all.size(), 4U);
    EXPECT_TRUE(all[1].done);
    EXPECT_EQ(all[2].due, "2026-06-01T12:00:00Z");
    EXPECT_FALSE(all[2].done);
    EXPECT_EQ(all[3].due, "2026-06-01T14:00:00Z");
}

TEST_F(Run, ACameraThatIsGoneIsAMissForEachSlotAndNoEnd)
{
    write_config("replay_script_left = 'gone 1'\n");
    const ToolRun run = rehearse(3, "2026-06-01T07:59:00Z");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    write_config();
    ASSERT_EQ(rehearse(1, "2026-06-01T13:00:00Z").exit_code, 0);
    const std::vector<Row> all = rows();
    ASSERT_EQ(all.size(), 4U);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_FALSE(all[i].done || all[i].reason.empty());
    EXPECT_TRUE(all[3].done);
}

TEST_F(Run, OnceTakesWhatIsDueOrElseASnapshotThatNobodyPlanned)
{
    write_config("", "", "at = []\n");
    ASSERT_EQ(dicot("run --once").exit_code, 0);
    write_config("replay_script_left = 'gone 1'\n", "", "every = '1m'\n"); // there is always one due
    EXPECT_EQ(dicot("run --once").exit_code, 69);
    const ToolRun missed = dicot("run --once");
    const std::vector<Row> all = rows();
    ASSERT_GE(all.size(), 2U);
    EXPECT_EQ(all[0].due, "");
    EXPECT_TRUE(all[0].done);
    EXPECT_FALSE(all[1].done);
    EXPECT_EQ(missed.exit_code, 69) << missed.output;
}

TEST_F(Run, SaysInOneSentenceWhatCannotBe)
{
    write_config("", "", "at = []\n");
    ToolRun run = dicot("run");
    EXPECT_EQ(run.exit_code, 78);
    EXPECT_THAT(run.output, HasSubstr("[schedule] names no time"));
    write_config();
    run = dicot("run --from 2026-06-01T08:00:00Z");
    EXPECT_EQ(run.exit_code, 64);
    run = rehearse(1, "yesterday");
    EXPECT_EQ(run.exit_code, 64);
    EXPECT_THAT(run.output, HasSubstr("2026-06-01T06:00:00Z"));
    std::ofstream(own_.path("dicot.toml")) << "[schedule]\nevery = '2h'\n[output]\nfolder = 'store'\n";
    run = rehearse(1, "");
    EXPECT_EQ(run.exit_code, 64);
    EXPECT_THAT(run.output, HasSubstr("replay:FOLDER"));
}

TEST_F(Run, ARigFileThatIsMissingIsAMissForEachSlot)
{
    std::filesystem::rename(own_.path("rig.yaml"), own_.path("elsewhere.yaml"));
    ASSERT_EQ(rehearse(2, "2026-06-01T07:59:00Z").exit_code, 0);
    const std::vector<Row> all = rows();
    ASSERT_EQ(all.size(), 2U);
    EXPECT_THAT(all[1].reason, HasSubstr("rig.yaml"));
}

} // namespace
} // namespace dicot
