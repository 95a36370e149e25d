// Snapshots in their folders: numbers, places, and what a start finds.
#include "store_scene.h"

#include "dicot/base/utc_time.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace dicot::test {
namespace {

namespace fs = std::filesystem;

class StoreTest : public StoreScene
{
};

TEST_F(StoreTest, ASnapshotStandsInTheFolderOfItsDayAndSha256sumAgrees)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon + 1).ok());
    EXPECT_STREQ(store.folder(), "2026-06-01/000001_20260601T120000Z");
    EXPECT_EQ(text_at("2026-06-01/000001_20260601T120000Z/cloud.drc"), "the points");
    const std::string command = "cd '" + at(store.folder()) + "' && sha256sum --quiet --strict -c SHA256SUMS";
    EXPECT_EQ(std::system(command.c_str()), 0);
    const auto rows = rows_of(store.catalogue());
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_TRUE(rows[0].done);
    EXPECT_EQ(rows[0].points, 10);
    EXPECT_EQ(rows[0].began_us, kNoon);
    std::int64_t bytes = 0;
    for (const auto& file : fs::directory_iterator(at(store.folder())))
        bytes += static_cast<std::int64_t>(file.file_size());
    EXPECT_EQ(rows[0].bytes, bytes);
    EXPECT_TRUE(fs::is_empty(at("incoming")));
}

TEST_F(StoreTest, NumbersGoOnAfterAStartAndAClockThatFellBack)
{
    ASSERT_TRUE(store_one(open(), kNoon).ok());
    ASSERT_TRUE(store_one(open(), 0).ok());
    Store& store = open();
    ASSERT_TRUE(miss_one(store, kNoon + kSecond, "no camera").ok());
    const auto rows = rows_of(store.catalogue());
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[1].sequence, 2);
    EXPECT_TRUE(is_at("1970-01-01/000002_19700101T000000Z/cloud.drc"));
    EXPECT_EQ(rows[2].sequence, 3);
    EXPECT_FALSE(rows[2].done);
    EXPECT_EQ(rows[2].reason, "no camera");
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(StoreTest, WhatWasBegunAndNotStoredIsAMissWithItsNumber)
{
    Store& first = open();
    ASSERT_TRUE(first.begin({kNoon, {}}).ok());
    ASSERT_TRUE(add_text(first, "cloud.drc", "half of the po").ok());
    Store& store = open();
    EXPECT_EQ(store.start_report().interrupted, 1);
    const auto rows = rows_of(store.catalogue());
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_FALSE(rows[0].done);
    EXPECT_TRUE(rows[0].reason.view().starts_with("interrupted"));
    EXPECT_FALSE(is_at("2026-06-01/000001_20260601T120000Z/cloud.drc"));
    EXPECT_EQ(verify().findings, 0);
    ASSERT_TRUE(store_one(store, kNoon).ok());
    EXPECT_EQ(store.sequence(), 2);
}

TEST_F(StoreTest, WhatWasPlannedAndInterruptedKeepsWhenItWasPlannedAndSaysWhy)
{
    Store& first = open();
    ASSERT_TRUE(first.begin({kNoon - 7'000'000, kNoon + 999'999}).ok());
    StoreRules rules;
    rules.cause = "in stage match";
    Store& store = open(rules);
    const auto rows = rows_of(store.catalogue());
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].due_us, kNoon);
    EXPECT_TRUE(rows[0].reason.view().ends_with(": in stage match"));
    EXPECT_TRUE(is_at("2026-06-01/000001_20260601T115953Z/record.json"));
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(StoreTest, WhatWasWholeAndNotYetInItsPlaceIsFinished)
{
    ASSERT_TRUE(store_one(open(), kNoon).ok());
    close();
    fs::rename(at("2026-06-01/000001_20260601T120000Z"), at("incoming/000001_20260601T120000Z"));
    fs::remove(catalogue_path());
    Store& store = open();
    EXPECT_EQ(store.start_report().finished, 1);
    EXPECT_EQ(text_at("2026-06-01/000001_20260601T120000Z/cloud.drc"), "the points");
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(StoreTest, OneAfterTheOtherInOneProcessAnAbandonedOneIsAMissToo)
{
    Store& store = open();
    ASSERT_TRUE(store.begin({kNoon, {}}).ok());
    ASSERT_TRUE(store_one(store, kNoon + kSecond).ok());
    const auto rows = rows_of(store.catalogue());
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_FALSE(rows[0].done);
    EXPECT_TRUE(rows[1].done);
}

TEST_F(StoreTest, AMissTakesBackWhatWasAdded)
{
    Store& store = open();
    ASSERT_TRUE(store.begin({kNoon, {}}).ok());
    ASSERT_TRUE(add_text(store, "cloud.drc", "points").ok());
    ASSERT_TRUE(store.take_back().ok());
    ASSERT_TRUE(add_text(store, "record.json", record_words(1, "2026-06-01T12:00:00Z", false, "too dark")).ok());
    ASSERT_TRUE(store.commit({false, "too dark", "set", 0}).ok());
    EXPECT_FALSE(is_at("2026-06-01/000001_20260601T120000Z/cloud.drc"));
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(StoreTest, RefusesWhatIsNoSnapshot)
{
    Store& store = open();
    EXPECT_FALSE(add_text(store, "cloud.drc", "nothing is begun").ok());
    ASSERT_TRUE(store.begin({kNoon, {}}).ok());
    for (const char* const name : {"../up", "a/b", ".hidden", "SHA256SUMS", "PULLED", "", "with space"})
        EXPECT_FALSE(add_text(store, name, "x").ok()) << name;
    EXPECT_FALSE(store.commit({true, "", "set", 0}).ok()) << "there is no record";
    EXPECT_TRUE(add_text(store, "one", "1").ok());
    EXPECT_FALSE(add_text(store, "one", "again").ok());
    EXPECT_EQ(text_at("incoming/000001_20260601T120000Z/one"), "1");
}

TEST_F(StoreTest, ALostCatalogueIsMadeAgainOfTheFolders)
{
    Store& first = open();
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(
            (i == 2 ? miss_one(first, kNoon + i * kSecond, "dark") : store_one(first, kNoon + i * kSecond)).ok());
    const auto rows = rows_of(first.catalogue());
    ASSERT_TRUE(first.mark_pulled(std::vector<Pull>{{1, rows[0].sums, kNoon + 60 * kSecond}}).ok());
    const auto before = rows_of(first.catalogue());
    close();
    fs::remove(catalogue_path());
    Store& store = open();
    EXPECT_TRUE(store.start_report().catalogue_new);
    EXPECT_EQ(rows_of(store.catalogue()), before);
    ASSERT_TRUE(store_one(store, kNoon).ok());
    EXPECT_EQ(store.sequence(), 6);
}

TEST_F(StoreTest, ADamagedCatalogueGoesToQuarantineAndIsMadeAgain)
{
    ASSERT_TRUE(store_one(open(), kNoon).ok());
    close();
    write_at(Store::kCatalogueName, "this is no database, however long it may be, and never was one: 123456789");
    Store& store = open();
    EXPECT_TRUE(store.start_report().catalogue_new);
    EXPECT_TRUE(is_at("quarantine/catalogue.sqlite"));
    EXPECT_EQ(rows_of(store.catalogue()).size(), 1U);
}

TEST_F(StoreTest, APullIsMarkedOnlyWithTheRightDigestAndOutlivesTheCatalogue)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    ASSERT_TRUE(store_one(store, kNoon + kSecond).ok());
    const auto rows = rows_of(store.catalogue());
    EXPECT_EQ(store.mark_pulled(std::vector<Pull>{{1, rows[0].sums, kNoon}, {2, rows[0].sums, kNoon}}).fault(),
              Fault::kBadData);
    EXPECT_FALSE(rows_of(store.catalogue())[0].pulled_us) << "none is marked when one is wrong";
    EXPECT_EQ(store.mark_pulled(std::vector<Pull>{{7, rows[0].sums, kNoon}}).fault(), Fault::kNoInput);
    ASSERT_TRUE(store.mark_pulled(std::vector<Pull>{{1, rows[0].sums, kNoon + 5 * kSecond}}).ok());
    EXPECT_EQ(rows_of(store.catalogue())[0].pulled_us, kNoon + 5 * kSecond);
    ASSERT_TRUE(store.mark_pulled(std::vector<Pull>{{1, rows[0].sums, kNoon + 9 * kSecond}}).ok());
    EXPECT_EQ(rows_of(store.catalogue())[0].pulled_us, kNoon + 5 * kSecond) << "the first one stands";
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(StoreTest, OnlyOneWritesAndOthersMayRead)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    const auto medium = open_disk_medium(root()).value();
    EXPECT_EQ(Store::open(*medium, {}, catalogue_path()).status().fault(), Fault::kTryAgain);
    const auto catalogue = read_catalogue(*medium, catalogue_path());
    ASSERT_TRUE(catalogue.ok()) << catalogue.status().message();
    EXPECT_EQ(rows_of(*catalogue.value()).size(), 1U);
    ASSERT_TRUE(store_one(store, kNoon + kSecond).ok());
    EXPECT_EQ(rows_of(*catalogue.value()).size(), 2U);
    close();
    EXPECT_TRUE(Store::open(*medium, {}, catalogue_path()).ok());
}

TEST_F(StoreTest, ACopyWithoutCatalogueIsReadFromItsFolders)
{
    ASSERT_TRUE(store_one(open(), kNoon).ok());
    close();
    for (const char* const name : {"catalogue.sqlite", "incoming", "leaving", "quarantine", "ballast"})
        fs::remove_all(at(name));
    const auto medium = open_disk_medium(root()).value();
    const auto catalogue = read_catalogue(*medium, catalogue_path());
    ASSERT_TRUE(catalogue.ok()) << catalogue.status().message();
    EXPECT_EQ(rows_of(*catalogue.value()).size(), 1U);
    EXPECT_FALSE(is_at("catalogue.sqlite"));
    const auto report = verify_store(
        *medium, catalogue_path(), [](const Finding&) {}, [](int, int) {});
    ASSERT_TRUE(report.ok()) << report.status().message();
    EXPECT_EQ(report.value().findings, 0);
}

TEST_F(StoreTest, ACardOfAnEnemyLeadsNowhereElse)
{
    const TempFolder elsewhere;
    elsewhere.write("precious", "keep me");
    ASSERT_TRUE(store_one(open(), kNoon).ok());
    close();
    fs::create_directory_symlink(elsewhere.path("."), at("2026-06-02"));
    fs::create_directory_symlink(elsewhere.path("."), at("incoming/000007_20260601T120000Z"));
    fs::create_directory_symlink(elsewhere.path("."), at("leaving/000008_20260601T120000Z"));
    fs::create_symlink(elsewhere.path("precious"), at("incoming/PULLED-1"));
    fs::create_directory(at("incoming/000009_20260601T120000Z"));
    fs::create_directory(at("incoming/000009_20260601T120000Z/deep"));
    fs::create_symlink(elsewhere.path("precious"), at("incoming/000009_20260601T120000Z/deep/cloud.drc"));
    fs::create_symlink(elsewhere.path("precious"), at("2026-06-01/000001_20260601T120000Z/more"));
    Store& store = open();
    EXPECT_GT(verify(true).findings, 0);
    ASSERT_TRUE(store_one(store, kNoon).ok());
    std::vector<SlotRow> gone;
    ASSERT_TRUE(store
                    .prune({.free_bytes = 0, .older_than_us = kNoon + kSecond, .dry_run = false},
                           [&](const SlotRow& row) { gone.push_back(row); })
                    .ok());
    EXPECT_EQ(elsewhere.files(), 1U);
    std::ifstream precious(elsewhere.path("precious"));
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(precious), {}), "keep me");
}

TEST_F(StoreTest, AFolderThatBearsTheLastNumberEndsTheSequenceWithASentence)
{
    ASSERT_TRUE(store_one(open(), kNoon).ok());
    close();
    fs::create_directories(at("quarantine/999999999_20260601T120000Z"));
    const Status status = open().begin({kNoon, {}});
    EXPECT_EQ(status.fault(), Fault::kBadData);
    EXPECT_NE(std::string(status.message()).find("999999999"), std::string::npos);
}

} // namespace
} // namespace dicot::test
