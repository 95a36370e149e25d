// dicot health and dicot diag: a store that has its troubles, told to a person, to a program, and to an engineer.
#include "store_commands.h"

#include <gmock/gmock.h>

#include <functional>

namespace dicot {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ToolRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class HealthCommand : public test::StoreOfOneBoard
{
protected:
    /// Writes a record anew, with the digest that belongs to it.
    static void rewrite(const fs::path& folder, const std::function<void(json&)>& change)
    {
        json record = json::parse(test::text_of(folder / "record.json"));
        change(record);
        std::ofstream(folder / "record.json") << record.dump();
        ASSERT_EQ(
            test::run("cd '" + folder.string() + "' && sha256sum $(ls | grep -v SHA256SUMS) >SHA256SUMS").exit_code, 0);
    }
    static json board(const std::string& root) { return report("health", root)["stores"].at(0); }
};

TEST_F(HealthCommand, AStoreIsToldWithStateMissesAndTrend)
{
    const std::string root = copy();
    const json told = board(root);
    EXPECT_EQ(told["device"], "bench");
    EXPECT_EQ(told["newest_snapshot"], 3);
    EXPECT_EQ(told["newest_slot"]["sequence"], 3);
    EXPECT_EQ(told["misses"]["slots"], 3);
    EXPECT_EQ(told["misses"]["missed"], 1);
    ASSERT_EQ(told["misses"]["reasons"].size(), 1U);
    EXPECT_THAT(told["misses"]["reasons"][0]["reason"].get<std::string>(), HasSubstr("is gone"));
    EXPECT_EQ(told["misses"]["reasons"][0]["newest"], 2);
    ASSERT_GE(told["trend"].size(), 1U); // two where midnight came between
    const json record = json::parse(test::text_of(snapshots(root)[2] / "record.json"));
    EXPECT_EQ(told["figures"]["luma"]["left"], record["shot"]["mean_luma"]["left"]);
    EXPECT_EQ(told["records_unread"], 0);
    const ToolRun words = ask("health", root);
    EXPECT_EQ(words.exit_code, 0);
    EXPECT_THAT(words.output, AllOf(HasSubstr("bench: "), HasSubstr("newest done   3: luma"),
                                    HasSubstr("1 of 3 slots in the last 7 days"), HasSubstr("filled %")));
    std::istringstream lines(words.output);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), 100U) << line;
}

TEST_F(HealthCommand, FlagsHaveCauseAndActionAndTheExitCodeStaysZero)
{
    const std::string root = copy();
    rewrite(snapshots(root)[2], [](json& record) {
        record["shot"]["mean_luma"] = {{"left", 10}, {"right", 11}};
        record["clock"]["trust"] = "not set";
        record["health"] = {{"epipolar", {{"median_px", 0.6}, {"points", 200}}},
                            {"focus", {{"left", 51}, {"right", 50}}}};
    });
    const json told = board(root);
    std::vector<std::string> ids;
    for (const json& flag : told["flags"]) {
        ids.push_back(flag["id"]);
        EXPECT_FALSE(flag["action"].get<std::string>().empty());
    }
    EXPECT_THAT(ids, testing::IsSupersetOf({"dark", "drift", "clock"}));
    EXPECT_EQ(told["state"], "warning");
    EXPECT_EQ(told["figures"]["epipolar"]["median_px"], 0.6);
    const ToolRun words = ask("health", root);
    EXPECT_EQ(words.exit_code, 0);
    EXPECT_THAT(words.output,
                AllOf(HasSubstr("warning"), HasSubstr("drift: The calibration does not fit: rows are 0.60 px"),
                      HasSubstr("dicot calibrate")));
}

TEST_F(HealthCommand, MissesSinceTheNewestSnapshotAreFlagged)
{
    const std::string root = copy();
    for (int i = 0; i < 2; ++i)
        ASSERT_EQ(snap(root, "replay_script_left = 'gone 1'\n").exit_code, 69);
    const json told = board(root);
    EXPECT_EQ(told["newest_snapshot"], 3);
    EXPECT_EQ(told["newest_slot"]["sequence"], 5);
    EXPECT_EQ(told["misses"]["reasons"][0]["count"], 3);
    const json& flags = told["flags"];
    ASSERT_FALSE(flags.empty());
    EXPECT_EQ(flags.back()["id"], "missed");
    EXPECT_THAT(flags.back()["cause"].get<std::string>(), HasSubstr("2 slots in a row were missed"));
}

TEST_F(HealthCommand, ADamagedAndAHostileRecordAreToldAndHarmNothing)
{
    const std::string root = copy();
    std::ofstream(snapshots(root)[0] / "record.json") << "{\"sequence\": 1";
    rewrite(snapshots(root)[2], [](json& record) {
        record["calibration_id"] = "\x1b[2J\x07";
        record["temperatures_c"] = {{"\x1b]0;x\x07", 1e300}};
        record["health"] = {
            {"flags", {"\x1b[31m"}}, {"epipolar", {{"median_px", "\x1b"}}}, {"focus", json::array({1})}};
        record["cloud"]["width"] = -1;
    });
    rewrite(snapshots(root)[1], [](json& record) { record["reason"] = "\x1b[2J\xE2\x80\xAE gone"; });
    fs::remove(root + "/bench/catalogue.sqlite");
    const json told = board(root);
    EXPECT_EQ(told["newest_snapshot"], 3);
    EXPECT_TRUE(told["figures"]["epipolar"].is_null());
    EXPECT_TRUE(told["figures"]["fill"].is_null());
    const ToolRun words = ask("health", root);
    EXPECT_THAT(words.output, AllOf(Not(HasSubstr("\x1b")), Not(HasSubstr("\x07")), HasSubstr("bench: ")));
    const ToolRun as_json = ask("health --json", root);
    EXPECT_THAT(as_json.output, Not(HasSubstr("\x1b")));
}

TEST_F(HealthCommand, WhereNothingIsAndWhereNoStoreIs)
{
    const test::TempFolder empty;
    EXPECT_THAT(ask("health", empty.path("")).output, HasSubstr("there is no snapshot yet"));
    EXPECT_EQ(ask("health", empty.path("absent")).exit_code, 66);
    EXPECT_EQ(ask("health --device other", copy()).exit_code, 66);
}

TEST_F(HealthCommand, DiagIsAnArchiveThatTarReads)
{
    DICOT_NEED_TOOL("tar", "tar");
    const std::string root = copy();
    test::flip_a_bit(snapshots(root)[0] / "record.json", 0);
    const std::string archive = own_.path("diag.tar.gz"), out = own_.path("out");
    const ToolRun made = ask("diag", root, " -o " + archive + " --records 2");
    ASSERT_EQ(made.exit_code, 0) << made.output;
    const ToolRun list = test::run("tar tzf " + archive);
    EXPECT_EQ(list.exit_code, 0) << list.output;
    for (const char* member :
         {"about.txt", "config.json", "config.toml", "rig.yaml", "health.json", "slots.json", "schedule.json",
          "boards/bench/store.json", "boards/bench/records/000002.json", "boards/bench/records/000003.json",
          "system/cpuinfo", "system/meminfo", "system/mounts", "system/uname", "system/clock.json", "system/limits"})
        EXPECT_THAT(list.output, HasSubstr(std::string("dicot-diag/") + member + "\n"));
    EXPECT_THAT(list.output, AllOf(Not(HasSubstr(".jpg")), Not(HasSubstr(".png")), Not(HasSubstr(".drc"))));
    fs::create_directory(out);
    ASSERT_EQ(test::run("tar xzf " + archive + " -C " + out).exit_code, 0);
    const fs::path in = fs::path(out) / "dicot-diag";
    EXPECT_EQ(json::parse(test::text_of(in / "boards/bench/records/000003.json")),
              json::parse(test::text_of(snapshots(root)[2] / "record.json")));
    EXPECT_EQ(test::text_of(in / "config.toml"), test::text_of(folder_->path("dicot.toml")));
    EXPECT_EQ(test::text_of(in / "rig.yaml"), test::text_of(folder_->path("rig.yaml")));
    EXPECT_EQ(json::parse(test::text_of(in / "slots.json"))["stores"][0]["slots"].size(), 3U);
    EXPECT_EQ(json::parse(test::text_of(in / "health.json"))["stores"][0]["newest_snapshot"], 3);
    EXPECT_EQ(json::parse(test::text_of(in / "boards/bench/store.json"))["quarantine"], 0);
    EXPECT_GT(test::text_of(in / "system/cpuinfo").size(), 50U);
}

TEST_F(HealthCommand, DiagSaysWhatIsNotToBeHadAndMakesTheRest)
{
    DICOT_NEED_TOOL("tar", "tar");
    const std::string archive = own_.path("diag.tar.gz");
    const ToolRun made = ask("diag", own_.path("absent"), " -o " + archive);
    ASSERT_EQ(made.exit_code, 0) << made.output;
    const ToolRun boards = test::run("tar xzOf " + archive + " dicot-diag/boards.missing.txt");
    EXPECT_EQ(boards.exit_code, 0);
    EXPECT_THAT(boards.output, HasSubstr("absent"));
    EXPECT_THAT(test::run("tar tzf " + archive).output,
                AllOf(HasSubstr("health.json.missing.txt"), HasSubstr("system/cpuinfo")));
    const ToolRun refused = ask("diag", copy(), " -o " + own_.path("no/such/folder.tar.gz"));
    EXPECT_EQ(refused.exit_code, 73) << refused.output;
    EXPECT_EQ(ask("diag", copy()).exit_code, 64) << "without -o";
}

TEST_F(HealthCommand, DiagHoldsEveryFileWhateverItsLength)
{
    DICOT_NEED_TOOL("tar", "tar");
    const std::string state = own_.path("state"), archive = own_.path("diag.tar.gz"), out = own_.path("out");
    fs::create_directory(state);
    fs::create_directory(out);
    for (const int bytes : {0, 1, 511, 512, 513, 5000, 100'000}) {
        std::string text;
        for (int i = 0; i < bytes; ++i)
            text += static_cast<char>('a' + (i * 7 + i / 26) % 26);
        std::ofstream(state + "/" + std::to_string(bytes)) << text;
    }
    std::ofstream(folder_->path("state.toml")) << "[run]\nstate = '" << state << "'\n";
    const ToolRun made =
        dicot("diag -o " + archive + " --store " + copy() + " --config " + folder_->path("state.toml"));
    ASSERT_EQ(made.exit_code, 0) << made.output;
    ASSERT_EQ(test::run("tar xzf " + archive + " -C " + out).exit_code, 0);
    EXPECT_EQ(test::run("diff -r " + state + " " + out + "/dicot-diag/state").output, "");
    EXPECT_EQ(test::run("test -d " + out + "/dicot-diag/state").exit_code, 0);
}

} // namespace
} // namespace dicot
