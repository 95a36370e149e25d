// The store on a card that loses power: after each change, in every way. DICOT_CRASH_CASE=subset:37:5 replays one case.
#include "crash_cases.h"

#include <gtest/gtest.h>

#include <cstdio>

using namespace dicot::test;

namespace {

class StoreAfterPowerLoss : public ::testing::Test
{
protected:
    void hold(const CrashPlan& plan)
    {
        const Recording recording = scene_.record();
        ASSERT_EQ(recording.story.refusals, 0) << recording.story.first_refusal;
        const CrashReport report = run_plan(scene_.vfs(), recording, plan);
        std::printf("%zu changes, %zu cuts, %zu states, %zu states of cut repairs\n", recording.log.size(), report.cuts,
                    report.states, report.repair_states);
        EXPECT_GT(report.states, 0U);
        for (const std::string& failure : report.failures)
            ADD_FAILURE() << failure;
    }

private:
    CrashScene scene_;
};

TEST_F(StoreAfterPowerLoss, keeps_its_promises_when_changes_last_in_order)
{
    hold({.mode = Cut::Mode::kInOrder, .seeds = 1, .repairs_every = 1});
}

TEST_F(StoreAfterPowerLoss, keeps_its_promises_whatever_was_not_synced_is_lost)
{
    hold({.mode = Cut::Mode::kSubset, .seeds = 150, .repairs_every = 2});
}

TEST_F(StoreAfterPowerLoss, keeps_its_promises_when_writes_are_torn)
{
    hold({.mode = Cut::Mode::kTorn, .seeds = 80, .repairs_every = 2});
}

} // namespace
