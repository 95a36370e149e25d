// That the judge can say no: the same story on cards, and in orders, that must lose something.
#include "crash_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <utility>

using namespace dicot::test;

namespace {

using Kind = Change::Kind;

/// The syncs of one kind become another.
std::vector<Change> with(std::vector<Change> log, std::initializer_list<Kind> kinds, Kind instead)
{
    for (Change& change : log)
        if (std::find(kinds.begin(), kinds.end(), change.kind) != kinds.end())
            change.kind = instead;
    return log;
}

/// Each sync of everything that stands directly before a rename comes after it.
std::vector<Change> with_renames_first(std::vector<Change> log)
{
    for (std::size_t k = 1; k < log.size(); ++k)
        if (log[k - 1].kind == Kind::kSyncAll && log[k].kind == Kind::kRename)
            std::swap(log[k - 1], log[k]);
    return log;
}

/// A folder is not synced where the change before it was of this kind.
std::vector<Change> without_folder_syncs_after(std::vector<Change> log, Kind kind)
{
    for (std::size_t k = 1; k < log.size(); ++k)
        if (log[k].kind == Kind::kSyncFolder && log[k - 1].kind == kind)
            log[k].kind = Kind::kNothing;
    return log;
}

class Judge : public ::testing::Test
{
protected:
    /// The first failures.
    std::vector<std::string> failures_with(std::vector<Change> log)
    {
        Recording changed{honest_.story, std::move(log)};
        const CrashReport report =
            run_plan(scene_.vfs(), changed, {.mode = Cut::Mode::kSubset, .seeds = 4, .most_failures = 1});
        for (const std::string& failure : report.failures)
            std::printf("found, as it must be: %s\n", failure.c_str());
        return report.failures;
    }

    CrashScene scene_;
    Recording honest_ = scene_.record();
};

TEST_F(Judge, has_nothing_against_the_honest_card)
{
    EXPECT_TRUE(failures_with(honest_.log).empty());
}

TEST_F(Judge, catches_a_card_that_syncs_nothing)
{
    EXPECT_FALSE(
        failures_with(with(honest_.log, {Kind::kSyncAll, Kind::kSyncFolder, Kind::kSyncFile}, Kind::kNothing)).empty());
}

TEST_F(Judge, catches_a_card_that_syncs_names_without_data)
{
    EXPECT_FALSE(failures_with(with(honest_.log, {Kind::kSyncAll}, Kind::kSyncNames)).empty());
}

/// What was whole before the rename is finished by the next start: this sync only spares it the work.
TEST_F(Judge, misses_nothing_where_the_sync_after_the_rename_is_lost)
{
    EXPECT_TRUE(failures_with(without_folder_syncs_after(honest_.log, Kind::kRename)).empty());
}

TEST_F(Judge, catches_a_number_that_is_not_synced)
{
    EXPECT_FALSE(failures_with(without_folder_syncs_after(honest_.log, Kind::kMake)).empty());
}

TEST_F(Judge, catches_a_rename_before_the_sync)
{
    EXPECT_FALSE(failures_with(with_renames_first(honest_.log)).empty());
}

/// In order nothing is lost, so there a lost sync cannot show.
TEST_F(Judge, needs_changes_out_of_order_to_see_it)
{
    Recording changed{honest_.story, with(honest_.log, {Kind::kSyncAll, Kind::kSyncFolder}, Kind::kNothing)};
    EXPECT_TRUE(run_plan(scene_.vfs(), changed, {.mode = Cut::Mode::kInOrder}).failures.empty());
}

TEST_F(Judge, catches_one_bit)
{
    const Moment end = honest_.log.size();
    const Told& last = honest_.story.all.back();
    const CardState whole = surviving({}, honest_.log, {Cut::Mode::kInOrder, end, 0});
    for (const char* name : {"cloud.drc", "left.jpg", "record.json", "SHA256SUMS"}) {
        CrashMedium card{whole};
        const int node = card.find_file((last.folder + "/" + name).c_str());
        ASSERT_GE(node, 0);
        const std::byte changed = whole.nodes[static_cast<std::size_t>(node)].bytes.front() ^ std::byte{4};
        ASSERT_TRUE(card.write_at(node, 0, std::span{&changed, 1}).ok());
        EXPECT_FALSE(judge(card, scene_.vfs(), honest_.story, end).verdict.empty()) << name;
    }
}

} // namespace
