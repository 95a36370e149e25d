// The store as the objects of a host: handles that mean the same for ever, and what a host may do to it.
#include "shelf_objects_scene.h"

#include "dicot/os/clock.h"

#include <cstdio>
#include <utility>

namespace dicot::test {
namespace {

constexpr Handle kJune1 = 0x80000000U + 20'605; ///< 2026-06-01 is 56 years, 14 leap days and 151 days after 1970-01-01
static_assert(56 * 365 + 14 + 151 == 20'605);

TEST_F(Objects, AHostThatTakesEverythingHasWhatIsOnTheDisk)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon, std::string(70'000, 'c')).ok());
    ASSERT_TRUE(miss_one(store, kNoon + kSecond, "no camera").ok());
    ASSERT_TRUE(store_one(store, kNoon + kDay).ok());
    ASSERT_TRUE(store.begin({kNoon + kDay, {}}).ok());
    look();
    EXPECT_EQ(everything(), on_the_disk());
    EXPECT_EQ(on_the_disk().size(), 4U + 2U + 4U);
    const mtp::Shelf shelf = look().shelf().value();
    EXPECT_EQ(shelf.label.view(), "board-3");
    EXPECT_EQ(shelf.total_bytes, fs::space(root()).capacity);
    EXPECT_GT(shelf.free_bytes, 0U);
    const mtp::Object snapshot = look().find(0x20).value();
    EXPECT_EQ(snapshot.made_us, kNoon + kSecond);
    EXPECT_EQ(snapshot.name.view(), "000002_20260601T120001Z");
}

TEST_F(Objects, HandlesAreTheSameAfterARestartAndWhenOthersCameAndWent)
{
    Store& store = open({.reserve_bytes = 0, .prune = Prune::kAll});
    for (int k = 0; k < 3; ++k)
        ASSERT_TRUE(store_one(store, kNoon + k * kDay / 2).ok());
    look();
    EXPECT_EQ(children(mtp::kRoot), std::vector<Handle>{1});
    EXPECT_EQ(children(1), (std::vector<Handle>{kJune1, kJune1 + 1}));
    EXPECT_EQ(children(kJune1), std::vector<Handle>{0x10});
    EXPECT_EQ(children(kJune1 + 1), (std::vector<Handle>{0x20, 0x30}));
    EXPECT_EQ(children(0x30), (std::vector<Handle>{0x31, 0x32, 0x33, 0x3F}));
    EXPECT_EQ(path_of(0x32), "board-3/2026-06-02/000003_20260602T120000Z/left.jpg");
    EXPECT_EQ(path_of(0x3F), "board-3/2026-06-02/000003_20260602T120000Z/SHA256SUMS");
    ASSERT_TRUE(store.prune({.free_bytes = 0, .older_than_us = kNoon + 1, .dry_run = false}, [](auto&) {}).ok());
    ASSERT_TRUE(store_one(store, kNoon + kDay).ok());
    look();
    EXPECT_EQ(children(1), std::vector<Handle>{kJune1 + 1});
    EXPECT_EQ(children(kJune1 + 1), (std::vector<Handle>{0x20, 0x30, 0x40}));
    EXPECT_EQ(path_of(0x32), "board-3/2026-06-02/000003_20260602T120000Z/left.jpg");
}

TEST_F(Objects, HandlesOfNothingAreNotThere)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    ShelfObjects& objects = look();
    std::size_t got = 1;
    std::byte byte{};
    for (const Handle handle :
         {Handle{0}, Handle{2}, Handle{0xF}, Handle{0x14}, Handle{0x18}, Handle{0x19}, Handle{0x1E}, Handle{0x20},
          Handle{0x2F}, kJune1 + 1, Handle{0x7FFFFFFF}, Handle{0x80000000}, Handle{0xFFFFFFFF}}) {
        EXPECT_EQ(objects.find(handle).status().fault(), Fault::kNoInput) << handle;
        EXPECT_EQ(objects.read(handle, 0, {&byte, 1}, got).fault(), Fault::kNoInput) << handle;
        if (handle != mtp::kRoot) {
            EXPECT_EQ(objects.children(handle, [](Handle) { return true; }).fault(), Fault::kNoInput) << handle;
        }
    }
    for (const Handle folder : {Handle{1}, kJune1, Handle{0x10}})
        EXPECT_EQ(objects.read(folder, 0, {&byte, 1}, got).fault(), Fault::kNoInput) << folder;
    EXPECT_EQ(objects.children(0x11, [](Handle) { return true; }).fault(), Fault::kNoInput) << "a file";
}

TEST_F(Objects, ASnapshotThatComesIsToldFolderByFolderAndFileByFile)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    ShelfObjects& objects = look();
    ASSERT_TRUE(store_one(store, kNoon + kDay).ok());
    std::vector<std::pair<Handle, bool>> told;
    const auto note = [&](const mtp::ObjectSource::Change& change) { told.emplace_back(change.handle, change.added); };
    ASSERT_TRUE(objects.refresh(note).ok());
    EXPECT_EQ(told, (std::vector<std::pair<Handle, bool>>{
                        {kJune1 + 1, true}, {0x20, true}, {0x21, true}, {0x22, true}, {0x23, true}, {0x2F, true}}));
    told.clear();
    fs::rename(at(std::string(store.folder())), at("quarantine/000002"));
    ASSERT_TRUE(objects.refresh(note).ok());
    EXPECT_EQ(told,
              (std::vector<std::pair<Handle, bool>>{
                  {0x21, false}, {0x22, false}, {0x23, false}, {0x2F, false}, {0x20, false}, {kJune1 + 1, false}}));
}

TEST_F(Objects, NotesSayWhatTheCatalogueSays)
{
    Store& store = open();
    for (int k = 0; k < 3; ++k)
        ASSERT_TRUE(store_one(store, kNoon + k * kSecond, std::string(static_cast<std::size_t>(1000 * k), 'c')).ok());
    look();
    const std::vector<SlotRow> rows = rows_of(store.catalogue());
    const auto all = notes();
    ASSERT_EQ(all.size(), rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        EXPECT_EQ(all[k].sequence, rows[k].sequence);
        EXPECT_EQ(all[k].began_us, rows[k].began_us);
        EXPECT_EQ(all[k].bytes, static_cast<std::uint64_t>(rows[k].bytes));
        EXPECT_EQ(all[k].folder, rows[k].sequence * 16);
        EXPECT_EQ(all[k].files, 4U);
        char digits[3];
        std::string hex;
        for (const std::byte byte : all[k].sums) {
            std::snprintf(digits, sizeof digits, "%02x", std::to_integer<unsigned>(byte));
            hex += digits;
        }
        EXPECT_EQ(hex, rows[k].sums.c_str());
    }
    EXPECT_EQ(notes(3).size(), 1U);
    EXPECT_EQ(notes(4).size(), 0U);
    EXPECT_EQ(notes(std::int64_t{1} << 62).size(), 0U);
}

TEST_F(Objects, AMarkIsWrittenByTheStoreAndStandsInItsFolder)
{
    ASSERT_TRUE(store_one(open(), kNoon).ok());
    ASSERT_TRUE(store_one(open(), kNoon + kSecond).ok());
    close();
    ShelfObjects& objects = look();
    const auto before = notes();
    const Status marked = objects.mark_pulled(std::vector{pulled(before[1]), pulled(before[1])}); // twice
    ASSERT_TRUE(marked.ok()) << marked.message();
    EXPECT_EQ(notes()[0], before[0]);
    EXPECT_TRUE(notes()[1].pulled);
    EXPECT_TRUE(is_at("2026-06-01/000002_20260601T120001Z/PULLED"));
    EXPECT_EQ(everything(), on_the_disk());
    const std::vector<SlotRow> rows = rows_of(open().catalogue());
    EXPECT_FALSE(rows[0].pulled_us);
    EXPECT_TRUE(rows[1].pulled_us);
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(Objects, AMarkIsRefusedWhenASlotIsUnderWayOrTheConfigurationOrTheDigestSaysNo)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    ASSERT_TRUE(store_one(store, kNoon + kSecond).ok());
    ShelfObjects& objects = look();
    const auto all = notes();
    ASSERT_TRUE(store.begin({kNoon + kDay, {}}).ok());
    const std::int64_t start_us = monotonic_us();
    EXPECT_EQ(objects.mark_pulled(std::vector{pulled(all[0])}).fault(), Fault::kTryAgain);
    EXPECT_LT(monotonic_us() - start_us, kSecond) << "it waited";
    close();
    EXPECT_EQ(objects.mark_pulled(std::vector{pulled(all[0]), mtp::PulledNote{2, all[0].sums}}).fault(),
              Fault::kBadData);
    EXPECT_EQ(objects.mark_pulled(std::vector{pulled(all[0]), mtp::PulledNote{77, all[0].sums}}).fault(),
              Fault::kNoInput);
    EXPECT_FALSE(notes()[0].pulled);
    ShelfSettings no_marks = settings();
    no_marks.marks = false;
    const Status refused = look(no_marks).mark_pulled(std::vector{pulled(all[0])});
    EXPECT_EQ(refused.fault(), Fault::kUsage);
    EXPECT_NE(std::string(refused.message()).find("usb.marks"), std::string::npos);
    EXPECT_FALSE(notes()[0].pulled);
}

TEST_F(Objects, AHostsTimeIsRefusedByABoardWhoseClockIsSet)
{
    ASSERT_TRUE(store_one(open(), kNoon).ok());
    close();
    ShelfSettings never = settings();
    never.clock_rule = "never";
    EXPECT_EQ(look(never).offer_time({kNoon + kDay}).fault(), Fault::kUsage);
    EXPECT_FALSE(is_at("clock-offer"));
}

TEST_F(Objects, WhatIsNotShownIsToldWithItsReason)
{
    for (int k = 0; k < 4; ++k)
        ASSERT_TRUE(store_one(open(), kNoon + k * kSecond).ok());
    close();
    EXPECT_EQ(app::hidden_words(look().hidden()).view(), "");
    ShelfSettings few = settings();
    few.limits.snapshots = 2;
    fs::remove(at("2026-06-01/000004_20260601T120003Z/SHA256SUMS"));
    ShelfObjects& objects = look(few);
    EXPECT_EQ(notes().size(), 1U);
    EXPECT_EQ(app::hidden_words(objects.hidden()).view(),
              "not shown to computers: 1 damaged (dicot verify names them), 2 "
              "older than what fits (pull, then prune)");
    constexpr std::size_t kMany = 4'000'000'000;
    EXPECT_EQ(app::hidden_words({kMany, kMany, kMany, kMany, kMany}).view().substr(0, 24), "not shown to computers: ");
}

} // namespace
} // namespace dicot::test
