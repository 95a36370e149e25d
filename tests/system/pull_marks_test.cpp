// What a board is told, and when; boards that meet in one archive.
#include "../storage/scripted_source.h"
#include "pull/pull_marks.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

using namespace dicot;
using namespace dicot::test;
using app::PullMarks;
using app::PullReport;

namespace {

constexpr std::int64_t kNoon = 1'780'315'200'000'000; ///< 2026-06-01T12:00:00Z

/// Keeps marks as a store does: all of a call, or none.
class MarkingSource final : public ScriptedSource
{
public:
    std::set<std::int64_t> pruned, marked;
    std::vector<std::size_t> calls; ///< how many each had
    Status answer;
    int busy = 0;             ///< so many calls
    std::string archive = {}; ///< not empty: what is marked must be there
    int marked_too_early = 0;

    Status mark(std::span<const Pulled> pulled) override
    {
        calls.push_back(pulled.size());
        if (busy-- > 0)
            return failure(Fault::kTryAgain, "a slot is running");
        TRY(answer);
        for (const Pulled& one : pulled)
            if (pruned.contains(one.sequence))
                return failure(Fault::kNoInput, "there is none");
        for (const Pulled& one : pulled) {
            marked.insert(one.sequence);
            marked_too_early += archive.empty() || is_in_archive(one) ? 0 : 1;
        }
        return {};
    }

private:
    bool is_in_archive(const Pulled& one) const
    {
        for (const ScriptedSnapshot& snapshot : all) {
            if (snapshot.offer.sequence != one.sequence || snapshot.offer.sums != one.sums)
                continue;
            char name[64];
            std::snprintf(name, sizeof name, "/tent/2026-06-01/%06d_20260601T120000Z/record.json",
                          static_cast<int>(one.sequence));
            return std::filesystem::exists(archive + name);
        }
        return false;
    }
};

void add(PullMarks& marks, int first, int last)
{
    for (int k = first; k <= last; ++k)
        marks.add({k, {}});
}

TEST(PullMarks, come_in_batches_as_soon_as_one_is_full)
{
    MarkingSource source;
    PullReport report;
    PullMarks marks(source, report, 0);
    add(marks, 1, 1200);
    EXPECT_EQ(source.calls, (std::vector<std::size_t>{512, 512}));
    marks.tell(true);
    EXPECT_EQ(source.marked.size(), 1200U);
    EXPECT_EQ(report.marked, 1200);
    EXPECT_EQ(report.unmarked, 0);
}

TEST(PullMarks, reach_the_board_although_one_of_them_is_pruned)
{
    MarkingSource source;
    source.pruned = {1, 77, 300};
    PullReport report;
    PullMarks marks(source, report, 0);
    add(marks, 1, 300);
    marks.tell(true);
    EXPECT_EQ(source.marked.size(), 297U);
    EXPECT_EQ(report.marked, 297);
    EXPECT_EQ(report.unmarked, 0) << "nobody needs the mark of what is gone";
    EXPECT_LT(source.calls.size(), 60U);
}

TEST(PullMarks, wait_for_a_busy_board_and_leave_it_when_their_patience_ends)
{
    MarkingSource source;
    source.busy = 1;
    PullReport report;
    PullMarks patient(source, report, 60'000'000);
    add(patient, 1, 3);
    patient.tell(true);
    EXPECT_EQ(report.marked, 3);
    source.busy = 1000;
    PullMarks hasty(source, report, 1);
    add(hasty, 4, 5);
    hasty.tell(true);
    EXPECT_EQ(report.unmarked, 2);
    EXPECT_LT(source.calls.size(), 6U);
}

TEST(PullMarks, that_are_full_while_the_board_is_busy_come_later)
{
    MarkingSource source;
    source.busy = 1;
    PullReport report;
    PullMarks marks(source, report, 0);
    add(marks, 1, 600);
    marks.tell(true);
    EXPECT_EQ(source.marked.size(), 600U);
    EXPECT_EQ(*std::ranges::max_element(source.calls), 512U);
}

TEST(PullMarks, are_not_offered_twice_to_who_takes_none)
{
    MarkingSource source;
    source.answer = failure(Fault::kBadData, "other digests");
    PullReport refused;
    PullMarks wrong(source, refused, 0);
    add(wrong, 1, 3);
    wrong.tell(true);
    EXPECT_EQ(refused.mark_refused, 3);
    source.calls.clear();
    source.answer = failure(Fault::kUsage, "usb.marks is off");
    PullReport report;
    PullMarks marks(source, report, 0);
    add(marks, 1, 2000);
    marks.tell(true);
    EXPECT_EQ(source.calls.size(), 1U);
    EXPECT_EQ(report.marks_why, "usb.marks is off");
    EXPECT_EQ(report.unmarked, 0);
}

class PullOneBoard : public ::testing::Test
{
protected:
    PullOneBoard()
    {
        wishes_.archive = folder_.path("archive");
        source_.archive = wishes_.archive;
        for (int k = 1; k <= 4; ++k)
            source_.all.push_back(honest(k, kNoon, 500));
    }
    PullReport pull(ScriptedSource& source)
    {
        app::BoardNames names;
        return pull_board(source, wishes_, names, screen_);
    }

    TempFolder folder_;
    app::PullWishes wishes_;
    app::PullScreen screen_;
    MarkingSource source_;
};

TEST_F(PullOneBoard, tells_it_only_of_what_is_in_its_place)
{
    const PullReport report = pull(source_);
    EXPECT_TRUE(report.outcome.ok()) << report.outcome.message();
    EXPECT_EQ(report.fresh, 4);
    EXPECT_EQ(report.marked, 4);
    EXPECT_EQ(source_.marked_too_early, 0);
}

TEST_F(PullOneBoard, tells_it_next_time_of_what_it_was_too_busy_for)
{
    wishes_.mark_patience_us = 1;
    source_.busy = 1000;
    EXPECT_EQ(pull(source_).outcome.fault(), Fault::kTryAgain);
    source_.busy = 0;
    const PullReport report = pull(source_);
    EXPECT_TRUE(report.outcome.ok());
    EXPECT_EQ(report.there, 4);
    EXPECT_EQ(source_.marked.size(), 4U);
}

TEST_F(PullOneBoard, goes_on_after_it_was_pulled_out_and_tells_what_arrived)
{
    source_.reads_left = 30;
    const PullReport cut = pull(source_);
    EXPECT_EQ(cut.outcome.fault(), Fault::kTryAgain);
    EXPECT_GT(cut.fresh, 0);
    EXPECT_LT(cut.fresh, 4);
    source_.reads_left = 10'000;
    const PullReport rest = pull(source_);
    EXPECT_TRUE(rest.outcome.ok());
    EXPECT_EQ(rest.fresh + cut.fresh, 4);
    EXPECT_EQ(source_.bytes_read["cloud.drc"], 4U * 500U);
    EXPECT_EQ(source_.marked.size(), 4U);
}

TEST_F(PullOneBoard, tells_it_of_no_copy_that_stopped_early_before_that_is_whole)
{
    (void)pull(source_);
    source_.marked.clear();
    std::filesystem::remove(wishes_.archive + "/tent/2026-06-01/000002_20260601T120000Z/cloud.drc");
    const PullReport report = pull(source_);
    EXPECT_TRUE(report.outcome.ok()) << report.outcome.message();
    EXPECT_EQ(report.fresh, 1);
    EXPECT_EQ(report.put_aside, 1);
    EXPECT_EQ(report.there, 3);
    EXPECT_EQ(source_.marked.size(), 4U);
    EXPECT_TRUE(std::filesystem::exists(wishes_.archive + "/tent/2026-06-01/000002_20260601T120000Z/cloud.drc"));
}

TEST_F(PullOneBoard, takes_what_it_owes_although_another_computer_has_it)
{
    for (ScriptedSnapshot& one : source_.all)
        one.offer.pulled = true;
    wishes_.all = true;
    source_.reads_left = 10;
    EXPECT_EQ(pull(source_).outcome.fault(), Fault::kTryAgain);
    wishes_.all = false;
    wishes_.verify = true;
    source_.reads_left = 10'000;
    const PullReport rest = pull(source_);
    EXPECT_TRUE(rest.outcome.ok()) << rest.outcome.message();
    EXPECT_EQ(rest.fresh, 1) << "the half part alone";
    EXPECT_EQ(rest.elsewhere, 3);
}

TEST_F(PullOneBoard, gives_up_after_some_failures_in_a_row)
{
    for (int k = 5; k <= 40; ++k)
        source_.all.push_back(honest(k, kNoon, 500));
    source_.reads_left = 0;
    source_.then = Fault::kIoError;
    const PullReport report = pull(source_);
    EXPECT_EQ(report.outcome.fault(), Fault::kTryAgain);
    EXPECT_EQ(report.unreadable, 8);
}

TEST_F(PullOneBoard, refuses_lists_that_lead_round_for_ever)
{
    source_.all.push_back(honest(2, kNoon, 500));
    const PullReport report = pull(source_);
    EXPECT_EQ(report.outcome.fault(), Fault::kBadData) << report.outcome.message();
    EXPECT_EQ(report.fresh, 0);
}

TEST_F(PullOneBoard, refuses_two_boards_of_one_name_at_once_and_one_after_the_other)
{
    app::BoardNames names;
    MarkingSource other;
    other.serial_number = "20000000b";
    other.all.push_back(honest(9, kNoon, 500));
    EXPECT_TRUE(pull_board(source_, wishes_, names, screen_).outcome.ok());
    EXPECT_EQ(pull_board(other, wishes_, names, screen_).outcome.fault(), Fault::kBadData);
    const PullReport later = pull(other);
    EXPECT_EQ(later.outcome.fault(), Fault::kBadData);
    EXPECT_NE(std::string{later.outcome.message()}.find("output.device"), std::string::npos) << later.outcome.message();
    EXPECT_EQ(later.fresh, 0);
}

} // namespace
