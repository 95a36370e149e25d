// The store on a card that loses power: after each change, in every way. DICOT_CRASH_CASE=subset:37:5 replays one case.
#include "crash_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

using namespace dicot;
using namespace dicot::test;

namespace {

class StoreAfterPowerLoss : public ::testing::Test
{
protected:
    void SetUp() override
    {
        recording_ = scene_.record();
        ASSERT_EQ(recording_.story.refusals, 0) << recording_.story.first_refusal;
    }
    void hold(const CrashPlan& plan, std::size_t least_states)
    {
        if (const char* only = std::getenv("DICOT_CRASH_CASE"))
            return replay(only);
        const CrashReport report = run_plan(scene_.vfs(), recording_, plan);
        std::printf("%zu changes, %zu cuts, %zu states, %zu states of cut repairs\n", recording_.log.size(),
                    report.cuts, report.states, report.repair_states);
        EXPECT_GT(report.states, least_states);
        EXPECT_GT(report.repair_states, 0U);
        for (const std::string& failure : report.failures)
            ADD_FAILURE() << failure;
    }
    void replay(const char* only)
    {
        const auto which = CrashCase::parse(only);
        ASSERT_TRUE(which) << only << " is no case, such as subset:37:5";
        const Verdict verdict = run_case(scene_.vfs(), recording_, *which);
        EXPECT_TRUE(verdict.empty()) << words_of(*which, verdict);
    }

    CrashScene scene_;
    Recording recording_;
};

TEST_F(StoreAfterPowerLoss, keeps_its_promises_when_changes_last_in_order)
{
    hold({.mode = Cut::Mode::kInOrder, .seeds = 1, .repairs_every = 2}, 100);
}

TEST_F(StoreAfterPowerLoss, keeps_its_promises_whatever_was_not_synced_is_lost)
{
    hold({.mode = Cut::Mode::kSubset, .seeds = 16, .repairs_every = 6}, 500);
}

TEST_F(StoreAfterPowerLoss, keeps_its_promises_when_writes_are_torn)
{
    hold({.mode = Cut::Mode::kTorn, .seeds = 8, .repairs_every = 6}, 400);
}

TEST_F(StoreAfterPowerLoss, keeps_its_promises_while_old_snapshots_make_room)
{
    CrashMedium card;
    recording_.story = tell_of_small_card(card, scene_.vfs());
    recording_.log = card.log();
    ASSERT_EQ(recording_.story.refusals, 0) << recording_.story.first_refusal;
    const auto renames = std::count_if(recording_.log.begin(), recording_.log.end(),
                                       [](const Change& change) { return change.kind == Change::Kind::kRename; });
    ASSERT_GT(static_cast<std::size_t>(renames), recording_.story.all.size()) << "nothing had to go";
    hold({.mode = Cut::Mode::kSubset, .seeds = 5, .repairs_every = 8}, 200);
}

/// When the next write to `name` begins, after `from`.
Moment next_write_to(const std::vector<Change>& log, const std::string& name, Moment from)
{
    int node = -1;
    for (Moment at = 0; at < log.size(); ++at) {
        if (log[at].kind == Change::Kind::kMake && log[at].name == name)
            node = log[at].node;
        if (log[at].kind == Change::Kind::kWrite && log[at].node == node && at >= from)
            return at;
    }
    return kNever;
}

TEST_F(StoreAfterPowerLoss, keeps_its_promises_while_rows_go_from_the_log_to_the_catalogue)
{
    constexpr int kSlots = 63; // SQLite's log is full shortly before
    recording_ = scene_.record_many(kSlots);
    ASSERT_EQ(recording_.story.refusals, 0) << recording_.story.first_refusal;
    const Moment opened = recording_.story.all.front().begin_from;
    const Moment checkpoint = next_write_to(recording_.log, Store::kCatalogueName, opened);
    ASSERT_LT(checkpoint, recording_.story.all.back().begin_from) << "the log was not full before the store was closed";
    hold({.mode = Cut::Mode::kTorn, .seeds = 2, .repairs_every = 8, .from = checkpoint - 5}, 20);
}

TEST_F(StoreAfterPowerLoss, keeps_its_promises_when_the_card_fails_once_during_the_repair)
{
    int cases = 0;
    constexpr std::size_t kStep = 7;
    for (std::size_t at = kStep; at < recording_.log.size() && !HasFailure(); at += kStep) {
        const CardState found = surviving({}, recording_.log, {Cut::Mode::kSubset, at, static_cast<unsigned>(at % 5)});
        bool struck = true;
        for (int k = 0; struck; k += 3, ++cases) {
            CrashMedium card{found};
            scene_.vfs().use(card);
            card.set_fault({EIO, k, false});
            (void)Store::open(card, {}, Store::kCatalogueName, CrashVfs::kName);
            struck = card.struck() != 0;
            card.set_fault({});
            const Verdict verdict = judge(card, scene_.vfs(), recording_.story, at).verdict;
            EXPECT_TRUE(verdict.empty()) << "read error " << k << " after "
                                         << words_of({{Cut::Mode::kSubset, at, 0}, {}}, verdict);
        }
    }
    std::printf("%d cases\n", cases);
    EXPECT_GT(cases, 100);
}

} // namespace
