// dicot list and dicot show: what a store tells, whoever wrote it.
#include "store_commands.h"

#include "dicot/base/utc_time.h"
#include "dicot/medium/disk_medium.h"

#include <gmock/gmock.h>

namespace dicot {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ToolRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using StoreList = test::StoreOfOneBoard;

std::vector<int> sequences(const json& report)
{
    std::vector<int> all;
    for (const json& slot : report["stores"].at(0)["slots"])
        all.push_back(slot["sequence"]);
    return all;
}

TEST_F(StoreList, EverySlotStandsThereWithItsStateReasonAndSize)
{
    const std::string root = copy();
    const json report = this->report("list", root);
    ASSERT_EQ(sequences(report), (std::vector<int>{1, 2, 3}));
    const json& slots = report["stores"][0]["slots"];
    EXPECT_EQ(report["stores"][0]["device"], "bench");
    EXPECT_EQ(slots[0]["outcome"], "done");
    EXPECT_TRUE(slots[0]["reason"].is_null());
    EXPECT_EQ(slots[1]["outcome"], "missed");
    EXPECT_THAT(slots[1]["reason"].get<std::string>(), HasSubstr("is gone"));
    for (const json& slot : slots) {
        const fs::path folder = fs::path(root) / "bench" / slot["folder"].get<std::string>();
        std::uintmax_t bytes = 0;
        for (const fs::directory_entry& file : fs::directory_iterator(folder))
            bytes += file.file_size();
        EXPECT_EQ(slot["bytes"], bytes) << slot;
        EXPECT_EQ(slot["points"], slot["outcome"] == "done"
                                      ? json::parse(test::text_of(folder / "record.json"))["cloud"]["points"]
                                      : json());
        EXPECT_TRUE(is_utc_time(slot["time"].get<std::string>()));
        EXPECT_TRUE(slot["pulled"].is_null());
    }
    const json& summary = report["stores"][0]["summary"];
    EXPECT_EQ(summary["done"], 2);
    EXPECT_EQ(summary["missed"], 1);
    EXPECT_EQ(summary["bytes_here"],
              slots[0]["bytes"].get<int>() + slots[1]["bytes"].get<int>() + slots[2]["bytes"].get<int>());
    EXPECT_EQ(summary["reserve_bytes"], 256 << 20);
    const ToolRun table = ask("list", root);
    EXPECT_EQ(table.exit_code, 0);
    EXPECT_THAT(table.output,
                AllOf(HasSubstr("bench"), HasSubstr("missed"), HasSubstr("is gone"),
                      HasSubstr("3 slots: 2 done, 1 missed; 0 pulled"), HasSubstr("256.0 MiB of it reserved")));
}

TEST_F(StoreList, SlotsAreChosenByTimeByMissAndByNumberOfTheNewest)
{
    const std::string root = copy();
    const json all = report("list", root)["stores"][0]["slots"];
    const std::string first = all[0]["time"];
    EXPECT_EQ(sequences(report("list --missed", root)), (std::vector<int>{2}));
    EXPECT_EQ(sequences(report("list --last 2", root)), (std::vector<int>{2, 3}));
    EXPECT_EQ(sequences(report("list --since " + first, root)), (std::vector<int>{1, 2, 3}));
    EXPECT_EQ(sequences(report("list --since 2001-01-01 --until 2001-12-31T23:59", root)), (std::vector<int>{}));
    EXPECT_EQ(
        sequences(report("list --until " + first.substr(0, 10) + " --since " + first.substr(0, 10), root)).front(), 1);
    EXPECT_EQ(sequences(report("list --until " + first.substr(0, 19), root)).front(), 1);
    for (const char* wrong : {"yesterday", "2026-02-30", "2026-06-01T25:00", "2026-06-01 12", "''"}) {
        const ToolRun run = ask("list --since " + std::string(wrong), root);
        EXPECT_EQ(run.exit_code, std::string(wrong) == "''" ? 0 : 64) << wrong << run.output;
    }
    for (const char* wrong :
         {"list --last 0", "show 0", "show abc", "show 1x", "show 9999999999999999999", "show 1000000000"}) {
        const ToolRun run = ask(wrong, root);
        EXPECT_EQ(run.exit_code, 64) << wrong << run.output;
        EXPECT_THAT(run.output, HasSubstr("give a number from 1 to 999,999,999")) << wrong;
        EXPECT_LT(run.output.size(), 120U) << run.output;
    }
    EXPECT_EQ(report("show 000003", root)["slot"]["sequence"], 3);
}

TEST_F(StoreList, SeveralBoardsOneBoardAndABoardsOwnFolder)
{
    const std::string root = copy();
    fs::rename(root + "/bench", root + "/a");
    fs::copy(root + "/a", root + "/b", fs::copy_options::recursive);
    fs::create_directory(root + "/other");
    fs::create_directory_symlink(root + "/a", root + "/link");
    const json report = this->report("list", root);
    ASSERT_EQ(report["stores"].size(), 2U);
    EXPECT_EQ(report["stores"][0]["device"], "a");
    EXPECT_EQ(report["stores"][1]["device"], "b");
    EXPECT_EQ(this->report("list --device b", root)["stores"].size(), 1U);
    EXPECT_EQ(this->report("list", root + "/b/")["stores"][0]["device"], "b");
    const ToolRun unknown = ask("list --device c", root);
    EXPECT_EQ(unknown.exit_code, 66);
    EXPECT_THAT(unknown.output, HasSubstr("no snapshots of a board called c"));
    const ToolRun both = ask("show 1", root);
    EXPECT_EQ(both.exit_code, 64);
    EXPECT_THAT(both.output, HasSubstr("2 boards have a slot 1: say which with --device, e.g. a"));
    EXPECT_EQ(ask("show 1 --device a", root).exit_code, 0);
    EXPECT_EQ(ask("show 1", root + "/a").exit_code, 0);
}

TEST_F(StoreList, WhereNothingIsThatIsSaid)
{
    const test::TempFolder empty;
    const ToolRun none = ask("list", empty.path(""));
    EXPECT_EQ(none.exit_code, 0);
    EXPECT_THAT(none.output, HasSubstr("there is no snapshot yet: dicot snap makes one"));
    EXPECT_EQ(ask("verify", empty.path("")).exit_code, 0);
    EXPECT_EQ(ask("prune", empty.path("")).exit_code, 0);
    EXPECT_EQ(empty.files(), 0U);
    EXPECT_EQ(ask("show 1", empty.path("")).exit_code, 66);
    for (const char* command : {"list", "show 1", "verify", "verify --repair", "prune"}) {
        const ToolRun absent = ask(command, empty.path("absent"));
        EXPECT_EQ(absent.exit_code, 66) << command << absent.output;
        EXPECT_THAT(absent.output, HasSubstr("absent: ")) << command;
    }
    EXPECT_EQ(empty.files(), 0U);
}

TEST_F(StoreList, ShowTellsTheRecordAndThatTheFilesAreWhole)
{
    const std::string root = copy();
    const fs::path folder = snapshots(root).front();
    const json shown = report("show 1", root);
    EXPECT_EQ(shown["record"], json::parse(test::text_of(folder / "record.json")));
    EXPECT_EQ(shown["folder"], folder.string());
    EXPECT_EQ(shown["slot"]["sequence"], 1);
    EXPECT_EQ(shown["files"],
              (json{{"SHA256SUMS", "ok"}, {"cloud.drc", "ok"}, {"left.jpg", "ok"}, {"record.json", "ok"}}));
    const ToolRun words = ask("show 1", root);
    EXPECT_EQ(words.exit_code, 0);
    EXPECT_THAT(words.output,
                AllOf(HasSubstr("1 of bench: done"), HasSubstr(folder.string()), HasSubstr("recorded pictures"),
                      HasSubstr("4 files, all as they were written"), HasSubstr("drawn-pair")));
    EXPECT_THAT(ask("show 2", root).output, AllOf(HasSubstr("2 of bench: missed"), HasSubstr("is gone")));
}

TEST_F(StoreList, ShowNamesTheNearestOfANumberThatIsNotThere)
{
    const ToolRun beyond = ask("show 9", copy());
    EXPECT_EQ(beyond.exit_code, 66);
    EXPECT_THAT(beyond.output, HasSubstr("there is no slot 9: bench has 3"));
    EXPECT_EQ(ask("show 00000010", copy()).exit_code, 66); // ten, not eight
}

TEST_F(StoreList, ShowNamesADamagedFile)
{
    const std::string root = copy();
    test::flip_a_bit(snapshots(root).front() / "cloud.drc", 700);
    const ToolRun shown = ask("show 1", root);
    EXPECT_EQ(shown.exit_code, 65);
    EXPECT_THAT(shown.output, HasSubstr("cloud.drc: its bytes are not those that were stored"));
    EXPECT_THAT(report("show 1", root)["files"]["cloud.drc"].get<std::string>(), HasSubstr("not those"));
    std::ofstream(snapshots(root).front() / "record.json") << "{}";
    EXPECT_EQ(ask("show 1", root).exit_code, 65);
    EXPECT_TRUE(report("show 1", root)["record"].is_null());
}

TEST_F(StoreList, AStoreThatAnotherProcessWritesToIsRead)
{
    const std::string root = copy();
    const auto medium = open_disk_medium(root + "/bench");
    ASSERT_TRUE(medium.ok());
    ASSERT_TRUE(medium.value()->lock().ok());
    for (const char* command : {"list", "show 1", "verify"})
        EXPECT_EQ(ask(command, root).exit_code, 0) << command;
    for (const char* command : {"prune", "verify --repair"}) {
        const ToolRun run = ask(command, root);
        EXPECT_EQ(run.exit_code, 75) << command << run.output;
        EXPECT_THAT(run.output, HasSubstr("another dicot writes to this store"));
    }
}

TEST_F(StoreList, AReadOnlyCopyIsReadAndNotWrittenTo)
{
    DICOT_NEED_TOOL("setpriv", "util-linux");
    const std::string root = copy();
    ASSERT_EQ(test::run("chmod -R a=rX " + root + " && chmod a+rx " + own_.path("") + " && chmod a+rx " +
                        folder_->path("") + " && chmod a+r " + folder_->path("*.*"))
                  .exit_code,
              0);
    // Root may write whatever the permissions are: another user asks then.
    const std::string user = ::geteuid() == 0 ? "setpriv --reuid=65534 --regid=65534 --clear-groups " : "";
    const auto ask_as = [&](const std::string& command) {
        const std::string words = config();
        (void)test::run("chmod a+r " + folder_->path("dicot.toml"));
        return test::run(user + DICOT_PROGRAM + " " + command + words + "--store " + root);
    };
    for (const char* command : {"list", "show 1", "verify"}) {
        const ToolRun run = ask_as(command);
        EXPECT_EQ(run.exit_code, 0) << command << run.output;
    }
    EXPECT_THAT(ask_as("list").output, HasSubstr("3 slots: 2 done"));
    for (const char* command : {"verify --repair", "prune", "snap"}) {
        const ToolRun run = ask_as(command);
        EXPECT_THAT(run.exit_code, testing::AnyOf(73, 74)) << command << run.output;
        EXPECT_THAT(run.output, HasSubstr("dicot: ")) << command;
    }
}

TEST_F(StoreList, ACardOfAnEnemyPrintsNothingThatATerminalObeys)
{
    const std::string root = copy();
    const fs::path folder = snapshots(root)[1];
    json record = json::parse(test::text_of(folder / "record.json"));
    for (const char* key : {"reason", "source", "software", "calibration_id"})
        record[key] = "\x1b[2J\x07 \xE2\x80\xAE gone";
    record["temperatures_c"] = {{"\x1b]0;x\x07", 1e300}};
    record["warnings"] = {"\x1b[31m", 1, nullptr, json::array({json::object()})};
    record["cameras"] = {{"left", {{"name", "\x1b"}}}, {"right", 7}};
    record["shot"] = {{"skew_us", "\x1b"}};
    std::ofstream(folder / "record.json") << record.dump();
    ASSERT_EQ(test::run("cd " + folder.string() + " && sha256sum record.json >SHA256SUMS").exit_code, 0);
    std::ofstream(folder / "\x1b[0m\r\nx") << "?";
    fs::remove(root + "/bench/catalogue.sqlite");
    fs::rename(root + "/bench", root + "/\x1b[5mbench\n");
    for (const char* command : {"list", "show 2", "verify", "list --json", "show 2 --json", "verify --json"}) {
        const ToolRun run = ask(command, root);
        EXPECT_EQ(run.output.find("gone") != std::string::npos, std::string(command).find("verify") != 0) << command;
        EXPECT_THAT(run.output, AllOf(Not(HasSubstr("\x1b")), Not(HasSubstr("\x07")), Not(HasSubstr("\xE2\x80\xAE"))))
            << command;
        EXPECT_NE(run.exit_code, 70) << command;
        EXPECT_LT(run.exit_code, 128) << command;
    }
}

} // namespace
} // namespace dicot
