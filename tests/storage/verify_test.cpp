// verify names what is damaged, and repair keeps what is not.
#include "store_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace dicot::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFirst = "2026-06-01/000001_20260601T120000Z";

class VerifyTest : public StoreScene
{
protected:
    void SetUp() override
    {
        Store& store = open();
        for (int i = 0; i < 3; ++i)
            ASSERT_TRUE(store_one(store, kNoon + i * kSecond).ok());
        const Pull pull{1, rows_of(store.catalogue())[0].sums, kNoon};
        ASSERT_TRUE(store.mark_pulled(std::span(&pull, 1)).ok());
    }
    bool names(const std::string& place) const
    {
        return std::find(places.begin(), places.end(), place) != places.end();
    }
};

TEST_F(VerifyTest, ABitFlippedInEachFileIsNamedWhereverItIs)
{
    const std::string folder = kFirst;
    for (const char* const name : {"cloud.drc", "left.jpg", "record.json", "SHA256SUMS", "PULLED"}) {
        const std::string path = folder + "/" + name;
        const std::string whole = text_at(path);
        for (std::size_t byte = 0; byte < whole.size(); ++byte) {
            const std::size_t bit = 8 * byte + byte % 8;
            std::string flipped = whole;
            flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
            write_at(path, flipped);
            verify();
            ASSERT_TRUE(names(path)) << name << ", bit " << bit;
            ASSERT_EQ(places.size(), 1U) << name << ", bit " << bit << ": " << places[1];
        }
        write_at(path, whole);
    }
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(VerifyTest, AFolderDeletedByHandIsNamedAndRepairedToALostRow)
{
    fs::remove_all(at(kFirst));
    EXPECT_EQ(verify().findings, 1);
    EXPECT_TRUE(names(kFirst));
    EXPECT_EQ(verify(true).mended, 1);
    Store& store = open();
    EXPECT_EQ(rows_of(store.catalogue())[0].kept, Kept::kLost);
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(VerifyTest, AMissingAndAStrangeFileAreNamed)
{
    fs::remove(at(std::string(kFirst) + "/left.jpg"));
    write_at(std::string(kFirst) + "/notes.txt", "mine");
    write_at("2026-06-01/notes.txt", "mine");
    write_at("notes.txt", "mine");
    EXPECT_EQ(verify().findings, 4);
    EXPECT_TRUE(names(std::string(kFirst) + "/left.jpg"));
    EXPECT_TRUE(names(std::string(kFirst) + "/notes.txt"));
    EXPECT_TRUE(names("2026-06-01/notes.txt"));
    EXPECT_TRUE(names("notes.txt"));
}

TEST_F(VerifyTest, RepairMovesADamagedFolderToQuarantineAndDeletesNothing)
{
    write_at(std::string(kFirst) + "/cloud.drc", "other points");
    const VerifyReport report = verify(true);
    EXPECT_EQ(report.in_quarantine, 1);
    EXPECT_EQ(text_at("quarantine/000001_20260601T120000Z/cloud.drc"), "other points");
    Store& store = open();
    EXPECT_EQ(rows_of(store.catalogue())[0].kept, Kept::kQuarantined);
    EXPECT_EQ(verify().findings, 0);
    ASSERT_TRUE(store_one(store, kNoon).ok());
    EXPECT_EQ(store.sequence(), 4);
}

TEST_F(VerifyTest, ARowThatDiffersIsNamedAndPutRight)
{
    Store& store = open();
    const auto before = rows_of(store.catalogue());
    SlotRow wrong = before[1];
    wrong.points = 5;
    ASSERT_TRUE(store.catalogue().put(wrong).ok());
    EXPECT_EQ(verify().findings, 1);
    EXPECT_EQ(kinds[0], Finding::Kind::kCatalogue);
    EXPECT_EQ(verify(true).mended, 1);
    EXPECT_EQ(rows_of(store.catalogue()), before);
}

TEST_F(VerifyTest, ADamagedMarkOfAPullIsWrittenAnewFromTheCatalogue)
{
    const std::string path = std::string(kFirst) + "/PULLED";
    const std::string whole = text_at(path);
    write_at(path, "2026");
    EXPECT_EQ(verify(true).mended, 1);
    EXPECT_EQ(text_at(path), whole);
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(VerifyTest, AnotherSnapshotUnderThisNumberIsNoSnapshot)
{
    close();
    fs::rename(at(kFirst), at("2026-06-01/000009_20260601T120000Z"));
    open();
    verify();
    EXPECT_TRUE(names("2026-06-01/000009_20260601T120000Z/record.json"));
    EXPECT_TRUE(names(kFirst));
}

TEST_F(VerifyTest, WhatAnInterruptionLeftIsNamedUnlessSomebodyIsWriting)
{
    close();
    fs::create_directory(at("incoming/000004_20260601T120000Z"));
    const auto medium = open_disk_medium(root()).value();
    int left = 0;
    const auto count = [&](const Finding& finding) { left += finding.kind == Finding::Kind::kLeftOver ? 1 : 0; };
    ASSERT_TRUE(verify_store(*medium, catalogue_path(), count, [](int, int) {}).ok());
    EXPECT_EQ(left, 1);
    Store& store = open();
    ASSERT_TRUE(store.begin({kNoon, {}}).ok());
    left = 0;
    ASSERT_TRUE(verify_store(*medium, catalogue_path(), count, [](int, int) {}).ok());
    EXPECT_EQ(left, 0);
}

TEST_F(VerifyTest, ADamagedCatalogueIsNamedByWhoOnlyReads)
{
    close();
    std::string bytes = text_at(Store::kCatalogueName);
    for (std::size_t i = 0; i < 64; ++i)
        bytes[i] = static_cast<char>(bytes[i] ^ 0x55);
    write_at(Store::kCatalogueName, bytes);
    const auto medium = open_disk_medium(root()).value();
    std::string place;
    const auto report = verify_store(
        *medium, catalogue_path(), [&](const Finding& finding) { place = finding.path; }, [](int, int) {});
    ASSERT_TRUE(report.ok()) << report.status().message();
    EXPECT_EQ(report.value().findings, 1);
    EXPECT_EQ(place, Store::kCatalogueName);
}

} // namespace
} // namespace dicot::test
