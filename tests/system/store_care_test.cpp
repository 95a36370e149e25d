// dicot verify and dicot prune, and what a snapshot does with a store that somebody spoiled.
#include "store_commands.h"

#include "dicot/medium/disk_medium.h"
#include "dicot/store/store.h"

#include <gmock/gmock.h>
#include <sys/timex.h>

namespace dicot {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ToolRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class StoreCare : public test::StoreOfOneBoard
{
protected:
    static std::string board(const std::string& root) { return root + "/bench"; }

    struct Opened
    {
        std::unique_ptr<Medium> medium;
        std::unique_ptr<Store> store;
    };
    static Opened open(const std::string& root)
    {
        Opened opened;
        opened.medium = std::move(open_disk_medium(board(root))).value();
        opened.store = std::move(Store::open(*opened.medium, {}, board(root) + "/" + Store::kCatalogueName)).value();
        return opened;
    }
    /// As a host marks them that has them.
    static void mark_pulled(const std::string& root, const std::vector<std::int64_t>& sequences)
    {
        const Opened opened = open(root);
        for (const std::int64_t sequence : sequences) {
            const Pull pull{sequence, opened.store->catalogue().find(sequence).value()->sums, 1'800'000'000'000'000};
            ASSERT_TRUE(opened.store->mark_pulled({&pull, 1}).ok());
        }
    }
    static std::vector<int> here(const std::string& root)
    {
        std::vector<int> numbers;
        const json told = report("list", root);
        for (const json& slot : told["stores"][0]["slots"])
            if (slot["kept"] == "here")
                numbers.push_back(slot["sequence"]);
        return numbers;
    }
    ToolRun prune(const std::string& root, const std::string& rule, const std::string& more) const
    {
        return dicot("prune --store " + root + config("", "prune = '" + rule + "'\nreserve_mib = 1\n") + more);
    }
};

TEST_F(StoreCare, ABitFlippedInEachFileIsNamed)
{
    const std::string root = copy();
    EXPECT_EQ(ask("verify", root).exit_code, 0);
    int files = 0;
    for (const fs::path& folder : snapshots(root))
        for (const fs::directory_entry& file : fs::directory_iterator(folder)) {
            const std::string before = test::text_of(file.path());
            test::flip_a_bit(file.path(), before.size() / 2);
            const ToolRun run = ask("verify", root);
            EXPECT_EQ(run.exit_code, 65) << file.path() << run.output;
            EXPECT_THAT(run.output, HasSubstr(file.path().string() + ": damaged: ")) << run.output;
            std::ofstream(file.path(), std::ios::binary) << before;
            ++files;
        }
    EXPECT_EQ(files, 4 + 2 + 4);
    EXPECT_EQ(ask("verify", root).exit_code, 0);
}

TEST_F(StoreCare, RepairMovesADamagedSnapshotToQuarantineAndTheListSaysSo)
{
    const std::string root = copy();
    test::flip_a_bit(snapshots(root).front() / "left.jpg", 900);
    const ToolRun repaired = ask("verify --repair", root);
    EXPECT_EQ(repaired.exit_code, 0) << repaired.output;
    EXPECT_THAT(repaired.output, AllOf(HasSubstr("left.jpg: damaged: "), HasSubstr("(dealt with)"),
                                       HasSubstr("1 folder in quarantine")));
    EXPECT_EQ(here(root), (std::vector<int>{2, 3}));
    EXPECT_THAT(ask("list", root).output, AllOf(HasSubstr("  quarantine  "), HasSubstr("1 in quarantine")));
    EXPECT_THAT(ask("show 1", root).output, HasSubstr("its folder was damaged, and is in quarantine"));
    EXPECT_EQ(std::distance(fs::directory_iterator(board(root) + "/quarantine"), {}), 1);
    const json again = report("verify", root);
    EXPECT_EQ(again["stores"][0]["damaged"], 0);
    EXPECT_EQ(again["stores"][0]["in_quarantine"], 1);
    EXPECT_EQ(snap(root).exit_code, 0);
    EXPECT_EQ(here(root), (std::vector<int>{2, 3, 4}));
}

TEST_F(StoreCare, AFolderThatSomebodyDeletedIsNamedAndThenLost)
{
    const std::string root = copy();
    const fs::path gone = snapshots(root).front();
    fs::remove_all(gone);
    const ToolRun seen = ask("verify", root);
    EXPECT_EQ(seen.exit_code, 65);
    EXPECT_THAT(seen.output, HasSubstr(gone.string() + ": missing: "));
    const ToolRun shown = ask("show 1", root);
    EXPECT_EQ(shown.exit_code, 65);
    EXPECT_THAT(shown.output, HasSubstr("the folder is not there"));
    EXPECT_EQ(ask("verify --repair", root).exit_code, 0);
    EXPECT_THAT(ask("list", root).output, HasSubstr("1 lost"));
    EXPECT_THAT(ask("show 1", root).output, HasSubstr("its folder was taken away"));
    EXPECT_EQ(ask("verify", root).exit_code, 0);
}

TEST_F(StoreCare, ALostOrDamagedCatalogueHidesNothingAndIsMadeAgain)
{
    for (const char* what : {"lost", "garbage", "a flipped bit"}) {
        const std::string root = copy();
        mark_pulled(root, {1});
        const json before = report("list", root)["stores"][0]["slots"];
        const std::string file = board(root) + "/" + Store::kCatalogueName;
        fs::remove(file + "-wal");
        fs::remove(file + "-shm");
        if (what == std::string("lost"))
            fs::remove(file);
        else if (what == std::string("garbage"))
            std::ofstream(file, std::ios::binary) << std::string(9000, '\x5a');
        else
            test::flip_a_bit(file, 30); // the header's
        EXPECT_EQ(report("list", root)["stores"][0]["slots"], before) << what;
        EXPECT_EQ(ask("show 3", root).exit_code, 0) << what;
        const ToolRun seen = ask("verify", root);
        EXPECT_EQ(seen.exit_code, 65) << what << seen.output;
        const ToolRun repaired = ask("verify --repair", root);
        EXPECT_EQ(repaired.exit_code, 0) << what << repaired.output;
        EXPECT_EQ(report("list", root)["stores"][0]["slots"], before) << what;
        EXPECT_EQ(ask("verify", root).exit_code, 0) << what;
        EXPECT_EQ(snap(root).exit_code, 0);
        EXPECT_EQ(here(root), (std::vector<int>{1, 2, 3, 4})) << what;
    }
}

TEST_F(StoreCare, ASnapshotThatWasInterruptedIsAMissOfTheNextStart)
{
    const std::string root = copy();
    {
        const Opened opened = open(root);
        ASSERT_TRUE(opened.store->begin({1'800'000'000'000'000, {}}).ok());
    }
    const ToolRun run = snap(root);
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.output, HasSubstr("1 snapshot interrupted: recorded as missed"));
    const json slots = report("list", root)["stores"][0]["slots"];
    ASSERT_EQ(slots.size(), 5U);
    EXPECT_EQ(slots[3]["outcome"], "missed");
    EXPECT_THAT(slots[3]["reason"].get<std::string>(), HasSubstr("interrupted"));
    EXPECT_EQ(slots[4]["outcome"], "done");
    // The interrupted slot claimed a time that is still to come.
    EXPECT_THAT(slots[4]["clock_trust"].get<std::string>(), testing::AnyOf("not set", "synchronised"));
}

TEST_F(StoreCare, OnlyWhatTheRuleAllowsIsPrunedAndNeverTheNewest)
{
    const std::string root = copy();
    mark_pulled(root, {1, 3});
    const std::string old = " --older-than 1e-9";
    EXPECT_EQ(prune(root, "never", old).exit_code, 0);
    EXPECT_EQ(here(root), (std::vector<int>{1, 2, 3}));
    const ToolRun told = prune(root, "pulled", old + " --dry-run");
    EXPECT_THAT(told.output, AllOf(HasSubstr("1 snapshot, "), HasSubstr("would go")));
    EXPECT_EQ(here(root), (std::vector<int>{1, 2, 3}));
    const ToolRun done = prune(root, "pulled", old + " --json");
    const json report = json::parse(done.output, nullptr, false);
    ASSERT_TRUE(report.is_object()) << done.output;
    EXPECT_EQ(report["stores"][0]["removed"], 1);
    EXPECT_EQ(report["stores"][0]["slots"][0]["sequence"], 1);
    EXPECT_EQ(here(root), (std::vector<int>{2, 3}));
    EXPECT_THAT(ask("show 1", root).output, HasSubstr("its folder was deleted to make room"));
    EXPECT_EQ(prune(root, "all", old).exit_code, 0);
    EXPECT_EQ(here(root), (std::vector<int>{3}));
    EXPECT_EQ(ask("verify", root).exit_code, 0);
    for (const char* wrong : {"nan", "inf", "-0", "0", "-1", "100001", "soon"}) {
        const ToolRun run = prune(root, "all", " --older-than=" + std::string(wrong));
        EXPECT_EQ(run.exit_code, 64) << wrong << run.output;
    }
}

TEST_F(StoreCare, NothingGrowsOldByAClockThatIsNotSet)
{
    const std::string root = copy();
    mark_pulled(root, {1});
    { // A clock that ran ahead: the newest slot lies in the future.
        const Opened opened = open(root);
        ASSERT_TRUE(opened.store->begin({1'900'000'000'000'000, {}}).ok());
    }
    (void)open(root);
    const ToolRun run = prune(root, "pulled", " --older-than 1e-9");
    timex discipline{};
    if (::adjtimex(&discipline) >= 0 && (discipline.status & STA_UNSYNC) == 0) {
        // What the kernel steers is believed whatever the store says.
        EXPECT_EQ(run.exit_code, 0) << run.output;
        EXPECT_EQ(here(root).front(), 2);
        return;
    }
    EXPECT_EQ(run.exit_code, 69) << run.output;
    EXPECT_THAT(run.output, HasSubstr("a clock that can be trusted"));
    EXPECT_EQ(here(root).front(), 1);
}

} // namespace
} // namespace dicot
