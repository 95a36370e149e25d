// Room is made as the rules say, oldest first.
#include "store_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace dicot::test {
namespace {

constexpr std::uint64_t kEverything = std::numeric_limits<std::uint64_t>::max() / 2;

class PruneTest : public StoreScene
{
protected:
    /// Six snapshots, of which 2, 4 and 6 were pulled.
    Store& fill(Prune prune)
    {
        Store& store = open({.reserve_bytes = 0, .prune = prune});
        for (int i = 0; i < 6; ++i)
            EXPECT_TRUE(store_one(store, kNoon + i * kSecond).ok());
        std::vector<Pull> pulls;
        for (const SlotRow& row : rows_of(store.catalogue()))
            if (row.sequence % 2 == 0)
                pulls.push_back({row.sequence, row.sums, kNoon});
        EXPECT_TRUE(store.mark_pulled(pulls).ok());
        return store;
    }
    std::vector<std::int64_t> pruned(Store& store, const PruneWish& wish)
    {
        std::vector<std::int64_t> gone;
        const auto report = store.prune(wish, [&](const SlotRow& row) { gone.push_back(row.sequence); });
        EXPECT_TRUE(report.ok()) << report.status().message();
        EXPECT_EQ(report.value().removed, static_cast<int>(gone.size()));
        return gone;
    }
};

using Numbers = std::vector<std::int64_t>;

TEST_F(PruneTest, OldestPulledOnesGoAndTheNewestStays)
{
    Store& store = fill(Prune::kPulled);
    EXPECT_EQ(pruned(store, {.free_bytes = kEverything, .older_than_us = {}, .dry_run = false}), (Numbers{2, 4}));
    EXPECT_FALSE(is_at("2026-06-01/000002_20260601T120001Z"));
    EXPECT_TRUE(is_at("2026-06-01/000001_20260601T120000Z/cloud.drc"));
    EXPECT_TRUE(is_at("2026-06-01/000006_20260601T120005Z/cloud.drc"));
    EXPECT_TRUE(std::filesystem::is_empty(at("leaving")));
    const auto rows = rows_of(store.catalogue());
    EXPECT_EQ(rows[1].kept, Kept::kPruned);
    EXPECT_TRUE(rows[1].pulled_us);
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(PruneTest, WhatNobodyHasGoesOnlyIfTheRuleSaysSoAndAfterTheRest)
{
    EXPECT_EQ(pruned(fill(Prune::kAll), {.free_bytes = kEverything, .older_than_us = {}, .dry_run = false}),
              (Numbers{2, 4, 1, 3, 5}));
    Store& never = open({.reserve_bytes = 0, .prune = Prune::kNever});
    EXPECT_EQ(pruned(never, {.free_bytes = kEverything, .older_than_us = {}, .dry_run = false}), Numbers{});
}

TEST_F(PruneTest, ADryRunTellsAndDeletesNothing)
{
    Store& store = fill(Prune::kPulled);
    EXPECT_EQ(pruned(store, {.free_bytes = kEverything, .older_than_us = {}, .dry_run = true}), (Numbers{2, 4}));
    EXPECT_TRUE(is_at("2026-06-01/000002_20260601T120001Z/cloud.drc"));
}

TEST_F(PruneTest, OnlyAsManyAsAreNeeded)
{
    Store& store = fill(Prune::kPulled);
    MediumSpace space;
    ASSERT_TRUE(medium().space(space).ok());
    // Other programs write to this disk too: a few bytes more than are free cannot be asked for without a margin.
    EXPECT_EQ(pruned(store, {.free_bytes = space.free_bytes / 2, .older_than_us = {}, .dry_run = false}), Numbers{});
    EXPECT_EQ(pruned(store, {.free_bytes = 0, .older_than_us = kNoon + 3 * kSecond, .dry_run = false}), Numbers{2});
}

TEST_F(PruneTest, ADeletionThatWasInterruptedIsEndedAndNotCalledALoss)
{
    fill(Prune::kPulled);
    close();
    // Between the renaming and the row.
    std::filesystem::rename(at("2026-06-01/000002_20260601T120001Z"), at("leaving/000002_20260601T120001Z"));
    Store& store = open();
    EXPECT_EQ(rows_of(store.catalogue())[1].kept, Kept::kPruned);
    EXPECT_TRUE(std::filesystem::is_empty(at("leaving")));
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(PruneTest, ACardWithoutRoomIsAReasonWithFiguresAndARemedy)
{
    fill(Prune::kPulled);
    Store& store = open({.reserve_bytes = kEverything, .prune = Prune::kPulled});
    ASSERT_TRUE(store.begin({kNoon, {}}).ok());
    const Status status = store.make_room();
    EXPECT_EQ(status.fault(), Fault::kIoError);
    EXPECT_NE(std::string(status.message()).find("MiB"), std::string::npos) << status.message();
    EXPECT_NE(std::string(status.message()).find("pull snapshots"), std::string::npos) << status.message();
    EXPECT_EQ(rows_of(store.catalogue())[1].kept, Kept::kPruned) << "what could go, went";
    ASSERT_TRUE(store.take_back().ok());
    ASSERT_TRUE(add_text(store, "record.json", record_words(7, "2026-06-01T12:00:00Z", false, "full")).ok());
    EXPECT_TRUE(store.commit({false, "full", "set", 0}).ok()) << "a miss is stored all the same";
}

} // namespace
} // namespace dicot::test
