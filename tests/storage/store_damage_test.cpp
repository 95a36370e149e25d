// No single damage stops a store for good, and repair costs nothing that is whole.
#include "passing_medium.h"
#include "store_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <utility>

namespace dicot::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFirst = "2026-06-01/000001_20260601T120000Z";
constexpr const char* kNext = "2026-06-01/000002_20260601T120001Z";
constexpr PruneWish kAllOfIt{std::numeric_limits<std::uint64_t>::max() / 2, {}, false};

class DamagedStore : public StoreScene
{
protected:
    void SetUp() override
    {
        Store& store = open(kGreedy);
        for (int i = 0; i < 4; ++i)
            ASSERT_TRUE(store_one(store, kNoon + i * kSecond).ok());
        close();
    }
    /// A store that opens, is made right by repair, and goes on.
    void expect_healed(std::int64_t next = 5)
    {
        Store& store = open(kGreedy);
        verify(true);
        EXPECT_EQ(verify().findings, 0) << (places.empty() ? "" : places[0] + ": " + sentences[0]);
        ASSERT_TRUE(store_one(store, kNoon + 60 * kSecond).ok());
        EXPECT_EQ(store.sequence(), next);
        EXPECT_TRUE(store.make_room().ok());
    }
    int prune_all()
    {
        const auto report = open(kGreedy).prune(kAllOfIt, [](const SlotRow&) {});
        EXPECT_TRUE(report.ok()) << report.status().message();
        return report.ok() ? report.value().removed : -1;
    }

    static constexpr StoreRules kGreedy{0, Prune::kAll};
};

TEST_F(DamagedStore, OpensWhicheverByteOfTheCataloguesRowsIsFlipped)
{
    const std::string sound = text_at(Store::kCatalogueName);
    const std::size_t first = sound.find("set"); // of the newest row, for rows are put from the page's end on
    ASSERT_NE(first, std::string::npos);
    for (std::size_t place = first - 40; place < first + 60; ++place)
        for (const int bit : {1, 0x80}) {
            close();
            fs::remove_all(at("quarantine"));
            std::string flipped = sound;
            flipped[place] = static_cast<char>(flipped[place] ^ bit);
            write_at(Store::kCatalogueName, flipped);
            Store& store = open(kGreedy);
            verify(true);
            ASSERT_EQ(verify().findings, 0) << "byte " << place << ", bit " << bit;
            const auto rows = rows_of(store.catalogue()); // a number that was flipped may leave a row of nothing
            const auto here =
                std::count_if(rows.begin(), rows.end(), [](const SlotRow& row) { return row.kept == Kept::kHere; });
            ASSERT_EQ(here, 4) << "byte " << place << ", bit " << bit;
        }
}

TEST_F(DamagedStore, AFolderOrALongNameInASnapshotEndsInQuarantine)
{
    fs::create_directory(at(std::string(kFirst) + "/mine"));
    write_at(std::string(kNext) + "/" + std::string(200, 'n'), "mine");
    EXPECT_EQ(prune_all(), 3);
    expect_healed();
    EXPECT_TRUE(is_at("quarantine/000001_20260601T120000Z/mine"));
    EXPECT_TRUE(is_at("quarantine/000002_20260601T120001Z"));
}

TEST_F(DamagedStore, AFileOfTerabytesIsDamageAndIsNotRead)
{
    fs::resize_file(at(std::string(kFirst) + "/cloud.drc"), std::uintmax_t{2} << 40);
    fs::remove(catalogue_path());
    expect_healed();
    EXPECT_TRUE(is_at("quarantine/000001_20260601T120000Z"));
}

TEST_F(DamagedStore, FilesAndLinksInPlaceOfItsRoomsAreMovedOutOfTheWay)
{
    const TempFolder elsewhere;
    fs::remove(at("quarantine"));
    fs::create_directory_symlink(elsewhere.path("."), at("quarantine"));
    fs::remove(at("incoming"));
    write_at("incoming", "mine");
    write_at(std::string(kFirst) + "/cloud.drc", "damaged");
    Store& store = open(kGreedy);
    verify(true);
    ASSERT_TRUE(store_one(store, kNoon + 60 * kSecond).ok());
    EXPECT_TRUE(is_at("quarantine/000001_20260601T120000Z"));
    EXPECT_EQ(text_at("incoming.strange"), "mine");
    EXPECT_EQ(elsewhere.files(), 0U);
}

TEST_F(DamagedStore, OfTwoFoldersWithOneNumberTheSnapshotStays)
{
    fs::create_directories(at("2026-01-01/000002_20260101T000000Z"));
    expect_healed();
    EXPECT_EQ(text_at(std::string(kNext) + "/cloud.drc"), "the points");
    EXPECT_TRUE(is_at("quarantine/000002_20260101T000000Z"));
}

TEST_F(DamagedStore, AFolderTakenAwayByHandDoesNotEndPruning)
{
    fs::remove_all(at(kFirst));
    EXPECT_EQ(prune_all(), 2);
    EXPECT_FALSE(is_at(kNext));
    expect_healed();
}

TEST_F(DamagedStore, AgeIsNotToldByAClockThatWasNotSet)
{
    Store& store = open(kGreedy);
    ASSERT_TRUE(store.begin({0, {}}).ok());
    ASSERT_TRUE(add_text(store, "record.json", record_words(5, "1970-01-01T00:00:00Z", false, "dark")).ok());
    ASSERT_TRUE(store.commit({false, "dark", "not set", 0}).ok());
    ASSERT_TRUE(store_one(store, kNoon + 60 * kSecond).ok());
    std::vector<std::int64_t> gone;
    const auto report =
        store.prune({0, kNoon + 2 * kSecond, false}, [&](const SlotRow& row) { gone.push_back(row.sequence); });
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(gone, (std::vector<std::int64_t>{1, 2}));
}

TEST_F(DamagedStore, APullThatOnlyTheCatalogueClaimsDeletesNothing)
{
    {
        Store& store = open(kGreedy);
        SlotRow row = rows_of(store.catalogue())[0];
        row.pulled_us = kNoon;
        ASSERT_TRUE(store.catalogue().put(row).ok());
    }
    Store& store = open({.reserve_bytes = 0, .prune = Prune::kPulled});
    const auto report = store.prune(kAllOfIt, [](const SlotRow&) {});
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.value().removed, 0);
    EXPECT_TRUE(is_at(std::string(kFirst) + "/cloud.drc"));
}

/// A card that will not open one file.
class ClosedFile final : public PassingMedium
{
public:
    ClosedFile(Medium& card, std::string path, int error) : PassingMedium(card), path_(std::move(path)), error_(error)
    {
    }

    Errno open(const char* path, File& file, std::uint64_t& size_bytes) override
    {
        return path == path_ ? Errno{error_} : PassingMedium::open(path, file, size_bytes);
    }

private:
    std::string path_;
    int error_;
};

TEST_F(DamagedStore, WhatCannotBeReadIsNamedAndNotMoved)
{
    for (const char* const file : {"/cloud.drc", "/SHA256SUMS", "/record.json"})
        for (const int error : {EACCES, EIO, EMFILE}) {
            const auto card = open_disk_medium(root()).value();
            ClosedFile closed(*card, kFirst + std::string(file), error);
            auto store = Store::open(closed, kGreedy, catalogue_path()).value();
            int mended = 0;
            const auto report = store->verify(
                true, [&](const Finding& finding) { mended += finding.mended ? 1 : 0; }, [](int, int) {});
            ASSERT_TRUE(report.ok()) << report.status().message();
            EXPECT_GT(report.value().findings, 0) << file << ", " << error;
            EXPECT_EQ(mended, 0) << file << ", " << error;
            EXPECT_TRUE(is_at(std::string(kFirst) + "/cloud.drc")) << file << ", " << error;
        }
    open(kGreedy);
    EXPECT_EQ(verify().findings, 0);
}

TEST_F(DamagedStore, AnOlderCatalogueGivesNoNumberTwice)
{
    const std::string older = text_at(Store::kCatalogueName);
    {
        Store& store = open(kGreedy);
        ASSERT_TRUE(store_one(store, kNoon + 10 * kSecond).ok());
        ASSERT_TRUE(store_one(store, kNoon + 11 * kSecond).ok());
    }
    close();
    write_at(Store::kCatalogueName, older);
    expect_healed(7);
}

} // namespace
} // namespace dicot::test
