#include "catalogue_cases.h"
#include "temp_folder.h"

#include "dicot/catalogue/catalogue.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <vector>

namespace dicot {
namespace {

using test::kDayUs;
using test::kFirstDayUs;
using test::slot_row;

std::unique_ptr<Catalogue> opened(const std::string& path, Catalogue::Access access = Catalogue::Access::kWrite)
{
    Result<std::unique_ptr<Catalogue>> catalogue = Catalogue::open(path, access);
    EXPECT_TRUE(catalogue.ok()) << catalogue.status().message();
    return catalogue.ok() ? std::move(catalogue).value() : nullptr;
}

void fill(Catalogue& catalogue, std::int64_t rows)
{
    const Status status = test::put_rows(catalogue, 1, rows);
    ASSERT_TRUE(status.ok()) << status.message();
}

std::vector<std::int64_t> asked(Catalogue& catalogue, const SlotQuery& query)
{
    std::vector<std::int64_t> found;
    const Status status = catalogue.for_each(query, [&](const SlotRow& row) {
        found.push_back(row.sequence);
        return true;
    });
    EXPECT_TRUE(status.ok()) << status.message();
    return found;
}

using Numbers = std::vector<std::int64_t>;

TEST(Catalogue, GivesBackWhatWasPut)
{
    const test::TempFolder folder;
    SlotRow odd = slot_row(7);
    odd.due_us.reset();
    odd.reason = "caméra – \"gauche\" 葉 \\ ';--";
    odd.kept = Kept::kQuarantined;
    odd.pulled_us = kFirstDayUs + 1;
    odd.began_us = -1'000'000; // before 1970: a clock may say so
    {
        const auto catalogue = opened(folder.path("c.sqlite"));
        ASSERT_TRUE(catalogue);
        ASSERT_TRUE(catalogue->put(slot_row(1)).ok());
        ASSERT_TRUE(catalogue->put(odd).ok());
        ASSERT_TRUE(catalogue->sync().ok());
    }
    const auto catalogue = opened(folder.path("c.sqlite"), Catalogue::Access::kRead);
    ASSERT_TRUE(catalogue);
    EXPECT_EQ(catalogue->find(1).value(), slot_row(1));
    EXPECT_EQ(catalogue->find(7).value(), odd);
    EXPECT_FALSE(catalogue->find(2).value().has_value());
    EXPECT_EQ(catalogue->last_sequence().value(), 7);
    EXPECT_TRUE(catalogue->check().ok());
    EXPECT_EQ(catalogue->put(odd).fault(), Fault::kIoError);
}

TEST(Catalogue, PutsOneRowInsteadOfAnother)
{
    const auto catalogue = opened(":memory:");
    ASSERT_TRUE(catalogue);
    EXPECT_EQ(catalogue->last_sequence().value(), 0);
    SlotRow row = slot_row(3);
    ASSERT_TRUE(catalogue->put(row).ok());
    row.pulled_us = kFirstDayUs;
    row.kept = Kept::kPruned;
    ASSERT_TRUE(catalogue->put(row).ok());
    EXPECT_EQ(catalogue->find(3).value(), row);
    EXPECT_EQ(catalogue->totals().value().slots, 1);
}

TEST(Catalogue, MakesTextPrintableAndRefusesNumbersOutOfRange)
{
    const auto catalogue = opened(":memory:");
    ASSERT_TRUE(catalogue);
    SlotRow row = slot_row(7);
    row.reason = "a\nb\x1B[2Jc\xFF\xC3";
    ASSERT_TRUE(catalogue->put(row).ok());
    EXPECT_EQ(catalogue->find(7).value()->reason.view(), "a\uFFFDb\uFFFD[2Jc\uFFFD\uFFFD");

    const auto refused = [&](auto change) {
        SlotRow wrong = slot_row(8);
        change(wrong);
        const Status status = catalogue->put(wrong);
        EXPECT_EQ(status.fault(), Fault::kSoftware) << status.message();
    };
    refused([](SlotRow& wrong) { wrong.sequence = 0; });
    refused([](SlotRow& wrong) { wrong.sequence = 1'000'000'000; });
    refused([](SlotRow& wrong) { wrong.began_us += 1; });
    refused([](SlotRow& wrong) { wrong.due_us = INT64_MAX; });
    refused([](SlotRow& wrong) { wrong.points = -1; });
    refused([](SlotRow& wrong) { wrong.bytes = -1; });
    refused([](SlotRow& wrong) { wrong.kept = static_cast<Kept>(4); });
    refused([](SlotRow& wrong) { wrong.sums = "abc"; });
    EXPECT_EQ(catalogue->totals().value().slots, 1);
}

TEST(Catalogue, AnswersQueriesInAscendingOrder)
{
    const auto catalogue = opened(":memory:");
    ASSERT_TRUE(catalogue);
    for (const std::int64_t i : {9, 2, 14, 7, 1})
        ASSERT_TRUE(catalogue->put(slot_row(i)).ok());
    SlotQuery query;
    EXPECT_EQ(asked(*catalogue, query), (Numbers{1, 2, 7, 9, 14}));
    query.last = 2;
    EXPECT_EQ(asked(*catalogue, query), (Numbers{9, 14}));
    query.last = 0;
    EXPECT_EQ(asked(*catalogue, query), Numbers{});
    query.last = 100;
    EXPECT_EQ(asked(*catalogue, query), (Numbers{1, 2, 7, 9, 14}));
    query = {};
    query.missed_only = true;
    EXPECT_EQ(asked(*catalogue, query), (Numbers{7, 14}));
    query.last = 1;
    EXPECT_EQ(asked(*catalogue, query), Numbers{14});
    query.until_us = slot_row(9).began_us;
    EXPECT_EQ(asked(*catalogue, query), Numbers{7});
    query = {};
    query.since_us = slot_row(2).began_us;
    query.until_us = slot_row(9).began_us;
    EXPECT_EQ(asked(*catalogue, query), (Numbers{2, 7, 9}));
    query = {};
    query.first_sequence = 2;
    query.last_sequence = 9;
    EXPECT_EQ(asked(*catalogue, query), (Numbers{2, 7, 9}));

    int visits = 0;
    ASSERT_TRUE(catalogue->for_each({}, [&](const SlotRow&) { return ++visits < 3; }).ok());
    EXPECT_EQ(visits, 3);
}

TEST(Catalogue, KnowsTheNewestSlotThatWasPlannedOnAClockThatIsBelieved)
{
    const auto catalogue = opened(":memory:");
    ASSERT_TRUE(catalogue);
    EXPECT_FALSE(catalogue->newest_planned(0).value());
    SlotRow asked_for = slot_row(4);
    asked_for.due_us.reset();
    SlotRow wrong_clock = slot_row(3);
    wrong_clock.clock_trust = "not set";
    for (const SlotRow& row : {slot_row(1), slot_row(2), wrong_clock, asked_for})
        ASSERT_TRUE(catalogue->put(row).ok());
    EXPECT_EQ(catalogue->newest_planned(0).value(), slot_row(2));
    EXPECT_FALSE(catalogue->newest_planned(*slot_row(2).due_us + 1).value());
}

TEST(Catalogue, MayBeChangedWhileItsRowsAreVisited)
{
    const auto catalogue = opened(":memory:");
    ASSERT_TRUE(catalogue);
    fill(*catalogue, 50);
    const Status status = catalogue->for_each({}, [&](const SlotRow& row) {
        SlotRow pruned = row;
        pruned.kept = Kept::kPruned;
        return catalogue->put(pruned).ok() && catalogue->find(row.sequence).ok();
    });
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(catalogue->totals().value().pruned, 50);
}

TEST(Catalogue, CountsAsOneWouldByHand)
{
    const auto catalogue = opened(":memory:");
    ASSERT_TRUE(catalogue);
    std::int64_t bytes = 0;
    for (std::int64_t i = 1; i <= 14; ++i) {
        SlotRow row = slot_row(i);
        row.kept = i <= 3 ? Kept::kPruned : i == 4 ? Kept::kQuarantined : i == 5 ? Kept::kLost : Kept::kHere;
        if (i <= 3)
            row.pulled_us = kFirstDayUs;
        bytes += row.kept == Kept::kHere ? row.bytes : 0;
        ASSERT_TRUE(catalogue->put(row).ok());
    }
    const SlotTotals totals = catalogue->totals().value();
    EXPECT_EQ(totals.slots, 14);
    EXPECT_EQ(totals.done, 12);
    EXPECT_EQ(totals.missed, 2);
    EXPECT_EQ(totals.pulled, 3);
    EXPECT_EQ(totals.pruned, 3);
    EXPECT_EQ(totals.quarantined, 1);
    EXPECT_EQ(totals.lost, 1);
    EXPECT_EQ(totals.bytes_here, bytes);
}

TEST(Catalogue, KnowsHowFastTheCardFillsAlsoAcrossAClockThatJumps)
{
    const auto catalogue = opened(":memory:");
    ASSERT_TRUE(catalogue);
    EXPECT_EQ(catalogue->pace().value().bytes_per_day, 0);
    SlotRow row;
    row.clock_trust = "none";
    row.done = true;
    row.bytes = 1000;
    for (row.sequence = 1; row.sequence <= 20; ++row.sequence) { // eight a day; the first ten in 1970
        row.began_us = (row.sequence <= 10 ? 0 : kFirstDayUs) + row.sequence * kDayUs / 8;
        ASSERT_TRUE(catalogue->put(row).ok());
        if (row.sequence == 1) {
            EXPECT_EQ(catalogue->pace().value().bytes_per_day, 0);
        }
    }
    SlotPace pace = catalogue->pace().value();
    EXPECT_NEAR(pace.bytes_per_day, 8000, 1e-6);
    EXPECT_NEAR(pace.bytes_per_snapshot, 1000, 1e-9);
    EXPECT_EQ(pace.most_bytes, 1000);
    row.bytes = 5000; // the clock falls back: the size counts, the step does not
    row.began_us = 0;
    ASSERT_TRUE(catalogue->put(row).ok());
    pace = catalogue->pace().value();
    EXPECT_NEAR(pace.bytes_per_day, 8000, 1e-6);
    EXPECT_EQ(pace.most_bytes, 5000);
}

TEST(Catalogue, ATransactionIsAllOrNothing)
{
    const test::TempFolder folder;
    {
        const auto catalogue = opened(folder.path("c.sqlite"));
        ASSERT_TRUE(catalogue);
        ASSERT_TRUE(catalogue->put(slot_row(1)).ok());
        ASSERT_TRUE(catalogue->begin().ok());
        ASSERT_TRUE(catalogue->put(slot_row(3)).ok());
        ASSERT_TRUE(catalogue->put(slot_row(2)).ok());
    } // let go before commit()
    const auto catalogue = opened(folder.path("c.sqlite"));
    ASSERT_TRUE(catalogue);
    EXPECT_EQ(asked(*catalogue, {}), Numbers{1});
    EXPECT_FALSE(catalogue->commit().ok());
}

TEST(Catalogue, HoldsTenThousandRowsInItsOwnMemory)
{
    const test::TempFolder folder;
    const auto start = std::chrono::steady_clock::now();
    const auto ms = [&] {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    const auto file = opened(folder.path("c.sqlite"));
    ASSERT_TRUE(file);
    fill(*file, 10'000);
    const double filled = ms();
    EXPECT_EQ(asked(*file, {}).size(), 10'000U);
    const double listed = ms();
    ASSERT_TRUE(file->check().ok());
    const double checked = ms();
    const auto again = opened(folder.path("c.sqlite"));
    ASSERT_TRUE(again);
    const double reopened = ms();
    EXPECT_EQ(again->pace().value().bytes_per_day > 0, true);
    const double paced = ms();
    const std::size_t of_file = Catalogue::peak_heap_bytes();
    const auto memory = opened(":memory:");
    ASSERT_TRUE(memory);
    fill(*memory, 10'000);
    EXPECT_EQ(memory->totals().value().slots, 10'000);
    std::printf("10,000 rows: put %.1f ms, visited %.1f, checked %.1f, opened for writing %.1f, pace %.2f; %zu KiB on "
                "disk; heap %zu KiB, with all rows in memory beside it %zu KiB\n",
                filled, listed - filled, checked - listed, reopened - checked, paced - reopened,
                test::bytes_of(folder.path("c.sqlite")).size() / 1024, of_file / 1024,
                Catalogue::peak_heap_bytes() / 1024);
    EXPECT_GT(of_file, std::size_t{100} << 10) << "SQLite takes its memory from elsewhere";
    EXPECT_LE(of_file, std::size_t{1} << 20);
    EXPECT_LE(Catalogue::peak_heap_bytes(), std::size_t{2} << 20);
}

TEST(Catalogue, MemoryThatIsUsedUpIsARefusalThatLeavesTheRestSound)
{
    const test::TempFolder folder;
    const auto file = opened(folder.path("c.sqlite"));
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->put(slot_row(1)).ok());
    {
        const auto memory = opened(":memory:");
        ASSERT_TRUE(memory);
        Status status;
        std::int64_t rows = 0;
        while (status.ok() && rows < 200'000)
            status = memory->put(slot_row(++rows));
        std::printf("%lld rows in memory, then: %s\n", static_cast<long long>(rows), status.message());
        EXPECT_EQ(status.fault(), Fault::kOsError) << status.message();
        EXPECT_GT(rows, 60'000);
        EXPECT_LE(Catalogue::peak_heap_bytes(), Catalogue::kHeapBytes);
        EXPECT_EQ(memory->find(1).value(), slot_row(1));
        (void)file->put(slot_row(2)); // may find no memory: then a Status
        const Result<std::unique_ptr<Catalogue>> third = Catalogue::open(":memory:", Catalogue::Access::kWrite);
        EXPECT_TRUE(third.ok() || third.status().fault() == Fault::kOsError) << third.status().message();
    }
    ASSERT_TRUE(file->put(slot_row(3)).ok());
    EXPECT_TRUE(file->check().ok());
}

} // namespace
} // namespace dicot
