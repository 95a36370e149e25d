// What the commands of a store say when a part of it cannot be read or written, and what they do with the rest.
#include "store_commands.h"

#include "dicot/medium/disk_medium.h"
#include "dicot/store/store.h"

#include <gmock/gmock.h>
#include <unistd.h>

namespace dicot {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ToolRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class StoreFaults : public test::StoreOfOneBoard
{
protected:
    /// Boards "a" and "b", alike.
    std::string two_boards() const
    {
        const std::string root = copy();
        fs::rename(root + "/bench", root + "/a");
        fs::copy(root + "/a", root + "/b", fs::copy_options::recursive);
        return root;
    }
    /// As a user whom permissions bind. Root may write and read whatever they are: another one asks then.
    ToolRun ask_bound(const std::string& command, const std::string& root) const
    {
        const std::string words = config();
        (void)test::run("chmod a+rX " + own_.path("") + " " + folder_->path("") + " " + folder_->path("*.*"));
        const std::string user = ::geteuid() == 0 ? "setpriv --reuid=65534 --regid=65534 --clear-groups " : "";
        return test::run(user + DICOT_PROGRAM + " " + command + words + "--store " + root);
    }
};

TEST_F(StoreFaults, ABoardThatCannotBeReadIsNamedAndTheOthersAreShown)
{
    DICOT_NEED_TOOL("setpriv", "util-linux");
    const std::string root = two_boards();
    fs::create_directory(root + "/lost+found");
    ASSERT_EQ(test::run("chmod -R a=rX " + root + " && chmod 0 " + root + "/b " + root + "/lost+found").exit_code, 0);
    for (const char* command : {"list", "list --json", "show 1", "verify", "verify --json"}) {
        const ToolRun run = ask_bound(command, root);
        EXPECT_EQ(run.exit_code, 66) << command << run.output;
        EXPECT_THAT(run.output, AllOf(HasSubstr(root + "/b: it cannot be read"), Not(HasSubstr("lost+found"))))
            << command;
        EXPECT_THAT(run.output, HasSubstr(root + "/a")) << command;
    }
    EXPECT_THAT(ask_bound("list", root).output, HasSubstr("3 slots: 2 done"));
    EXPECT_EQ(ask_bound("list --device a", root).exit_code, 0);
    EXPECT_EQ(ask_bound("list --device b", root).exit_code, 66);
    fs::permissions(root + "/b", fs::perms::owner_all);
    fs::permissions(root + "/lost+found", fs::perms::owner_all);
}

TEST_F(StoreFaults, WithoutACatalogueAFolderThatCannotBeReadIsNamedAndTheOthersAreListed)
{
    DICOT_NEED_TOOL("setpriv", "util-linux");
    const std::string root = copy();
    for (const char* end : {"", "-wal", "-shm"})
        fs::remove(root + "/bench/" + Store::kCatalogueName + end);
    EXPECT_EQ(ask("list", root).exit_code, 0);
    const fs::path closed = snapshots(root).front();
    ASSERT_EQ(test::run("chmod -R a=rX " + root + " && chmod 0 " + closed.string()).exit_code, 0);
    EXPECT_THAT(ask_bound("list", root).output,
                AllOf(HasSubstr("3 slots: 1 done, 2 missed"), HasSubstr("its record cannot be read")));
    EXPECT_THAT(ask_bound("show 1", root).output, AllOf(HasSubstr(root + "/bench"), HasSubstr("no permission")));
    EXPECT_EQ(ask_bound("show 3", root).exit_code, 0);
    fs::permissions(closed, fs::perms::owner_all);
    (void)test::run("chmod 0 " + closed.parent_path().string());
    for (const char* command : {"list", "list --json", "show 1"}) {
        const ToolRun run = ask_bound(command, root);
        EXPECT_EQ(run.exit_code, 74) << command << run.output;
        EXPECT_THAT(run.output, HasSubstr(closed.parent_path().string() + ": it cannot be read")) << command;
    }
    ASSERT_EQ(test::run("chmod -R u+rwX " + root).exit_code, 0);
}

TEST_F(StoreFaults, VerifyGoesOnToTheNextBoardAndSaysWhatItFound)
{
    const std::string root = two_boards();
    fs::path damaged;
    for (const fs::path& folder : snapshots(root + "/b"))
        damaged = damaged.empty() ? folder / "record.json" : damaged;
    test::flip_a_bit(damaged, 20);
    const auto medium = open_disk_medium(root + "/a");
    ASSERT_TRUE(medium.ok());
    ASSERT_TRUE(medium.value()->lock().ok());
    const ToolRun run = ask("verify --repair", root);
    EXPECT_EQ(run.exit_code, 75) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr(root + "/a: "), HasSubstr("another dicot writes to this store"),
                                  HasSubstr(damaged.string() + ": damaged: "), HasSubstr("1 folder in quarantine")));
    const json told = report("verify --repair", root);
    EXPECT_THAT(told["stores"].at(0)["error"].get<std::string>(), HasSubstr("another dicot writes"));
    EXPECT_FALSE(told["stores"].at(1).contains("error"));
    EXPECT_EQ(told["stores"].at(1)["in_quarantine"], 1);
    medium.value()->unlock();
    EXPECT_EQ(ask("verify", root).exit_code, 0);
}

TEST_F(StoreFaults, WhatTheOpeningOfAStoreMendedIsSaidByEachThatWrites)
{
    for (const char* command : {"verify --repair", "prune"}) {
        const std::string root = copy();
        const std::string file = root + "/bench/" + Store::kCatalogueName;
        const auto spoil = [&] {
            fs::remove(file + "-wal");
            fs::remove(file + "-shm");
            std::ofstream(file, std::ios::binary) << std::string(9000, '\x5a');
        };
        EXPECT_THAT(ask(command, root).output, Not(HasSubstr("made again"))) << command;
        spoil();
        EXPECT_THAT(ask(command, root).output,
                    AllOf(HasSubstr("bench: 3 snapshots that the catalogue did not know: added"),
                          HasSubstr("the catalogue was damaged or missing, and was made again of the folders")))
            << command;
        spoil();
        const json start = report(command, root)["stores"].at(0)["start"];
        EXPECT_EQ(start["rows_added"], 3) << command;
        EXPECT_EQ(start["catalogue_new"], true) << command;
    }
    const test::TempFolder fresh;
    const ToolRun first = snap(fresh.path("new"));
    EXPECT_EQ(first.exit_code, 0) << first.output;
    EXPECT_THAT(first.output, Not(HasSubstr("catalogue")));
}

TEST_F(StoreFaults, PruneSaysWhatIsMissingToTheReserve)
{
    const std::string root = copy();
    for (const char* rule : {"never", "pulled", "all"}) {
        const std::string words =
            " --store " + root + config("", "reserve_mib = 1048576\nprune = '" + std::string(rule) + "'\n");
        for (const char* how : {"prune --dry-run", "prune"}) {
            const ToolRun run = dicot(how + words);
            EXPECT_EQ(run.exit_code, 75) << rule << run.output;
            EXPECT_THAT(run.output, AllOf(HasSubstr("bench: "), HasSubstr("still missing to output.reserve_mib: "),
                                          HasSubstr(rule == std::string("all") ? "a larger card" : "output.prune")))
                << rule;
        }
    }
    const ToolRun told = test::run("{ " + std::string{DICOT_PROGRAM} + " prune --json --store " + root +
                                   config("", "reserve_mib = 1048576\n") + "2>/dev/null; }");
    const json parsed = json::parse(told.output, nullptr, false);
    ASSERT_TRUE(parsed.is_object()) << told.output;
    EXPECT_GT(parsed["stores"].at(0)["missing_bytes"], std::uint64_t{1} << 30U);
}

TEST_F(StoreFaults, NoStoreIsMadeInTheFolderOfABoard)
{
    const std::string root = copy();
    const std::string board = root + "/bench";
    const auto is_refused = [&](const char* what) {
        const ToolRun run = snap(board);
        EXPECT_EQ(run.exit_code, 64) << what << run.output;
        EXPECT_THAT(run.output, HasSubstr("this is the folder of one board: name the one around it")) << what;
        EXPECT_FALSE(fs::exists(board + "/bench")) << what;
    };
    is_refused("with its catalogue");
    for (const char* end : {"", "-wal", "-shm"})
        fs::remove(board + "/" + Store::kCatalogueName + end);
    is_refused("of days");
    for (const fs::path& folder : snapshots(root))
        fs::remove_all(folder.parent_path());
    is_refused("before its first snapshot");
}

TEST_F(StoreFaults, AFileThatMayNotGrowIsAMissThatIsRecorded)
{
    const std::string root = copy();
    // 64 KiB: enough for the catalogue and a record.
    const ToolRun run = test::run("ulimit -f 128; exec " + std::string{DICOT_PROGRAM} + " snap -o " + root + config());
    EXPECT_EQ(run.exit_code, 74) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("larger than a file may become here"), HasSubstr("the miss is recorded")));
    const json slots = report("list", root)["stores"].at(0)["slots"];
    ASSERT_EQ(slots.size(), 4U);
    EXPECT_THAT(slots[3]["reason"].get<std::string>(), HasSubstr("ulimit -f"));
    EXPECT_EQ(ask("verify", root).exit_code, 0);
}

TEST_F(StoreFaults, AFolderOfAnotherUserIsSaidToBeOne)
{
    DICOT_NEED_TOOL("setpriv", "util-linux");
    const std::string root = copy();
    const std::string board = root + "/bench";
    // All but the folder of what is being written.
    ASSERT_EQ(test::run("chmod -R a=rwX " + root + " && chmod a-w " + board + "/incoming").exit_code, 0);
    const ToolRun run = ask_bound("snap", root);
    EXPECT_EQ(run.exit_code, 74) << run.output;
    EXPECT_THAT(run.output,
                AllOf(HasSubstr("dicot: " + board + ": incoming/"), HasSubstr("no permission"), HasSubstr("chown")));
    fs::permissions(board + "/incoming", fs::perms::owner_all);
}

} // namespace
} // namespace dicot
