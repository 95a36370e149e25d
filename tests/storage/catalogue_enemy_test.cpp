// Catalogues that are not what they should be: damaged, foreign, forged.
#include "catalogue_cases.h"
#include "temp_folder.h"

#include "dicot/catalogue/catalogue.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <random>
#include <sys/stat.h>

namespace dicot {
namespace {

using Access = Catalogue::Access;
using test::slot_row;

/// What any program can do to a file with SQLite. In a process of its own: here SQLite has dicot's memory.
bool run_sql(const std::string& path, const std::string& sql)
{
    const int code = test::run_apart([&] {
        sqlite3* database = nullptr;
        char* why = nullptr;
        if (sqlite3_open(path.c_str(), &database) != SQLITE_OK)
            return 1;
        if (sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &why) != SQLITE_OK)
            std::fprintf(stderr, "%s\n", why);
        return why == nullptr && sqlite3_close(database) == SQLITE_OK ? 0 : 2;
    });
    return code == 0;
}

/// Whatever a catalogue can be asked; the first fault.
Status ask_everything(const std::string& path, Access access)
{
    const std::unique_ptr<Catalogue> catalogue = TRY(Catalogue::open(path, access));
    TRY(catalogue->for_each({}, [](const SlotRow&) { return true; }));
    SlotQuery newest;
    newest.last = 3;
    TRY(catalogue->for_each(newest, [](const SlotRow&) { return true; }));
    TRY(catalogue->find(2));
    TRY(catalogue->totals());
    TRY(catalogue->pace());
    return catalogue->check();
}

class CatalogueEnemy : public ::testing::Test
{
protected:
    std::string path() const { return folder_.path("c.sqlite"); }
    /// The catalogue alone, with these bytes.
    void put_bytes(const test::Bytes& bytes) const
    {
        for (const char* const end : {"-wal", "-shm", "-journal"})
            std::filesystem::remove(path() + end);
        folder_.write("c.sqlite", bytes);
    }
    void expect_refused(const char* what) const
    {
        for (const Access access : {Access::kRead, Access::kWrite}) {
            const Status status = ask_everything(path(), access);
            EXPECT_EQ(status.fault(), Fault::kBadData) << what << ": " << status.message();
            EXPECT_NE(std::string{status.message()}.find("verify --repair"), std::string::npos) << status.message();
        }
    }

    test::TempFolder folder_;
};

TEST_F(CatalogueEnemy, WhatIsNoCatalogueIsRefusedAndLeftAsItIs)
{
    const test::Bytes text(5000, 'x');
    put_bytes(text);
    expect_refused("text");
    EXPECT_EQ(test::bytes_of(path()), text);

    std::filesystem::remove(path());
    ASSERT_TRUE(run_sql(path(), "CREATE TABLE letters(a); INSERT INTO letters VALUES('private')"));
    const test::Bytes foreign = test::bytes_of(path());
    expect_refused("a database of another program");
    EXPECT_EQ(test::bytes_of(path()), foreign);
}

TEST_F(CatalogueEnemy, ATableThatDiffersInOneWordIsRefused)
{
    ASSERT_TRUE(test::make_catalogue(path(), 5));
    const test::Bytes sound = test::bytes_of(path());
    const char* const changes[] = {
        "PRAGMA user_version=2",
        "PRAGMA user_version=0",
        "PRAGMA application_id=1",
        "CREATE INDEX i ON slot(began_us)",
        "CREATE VIEW v AS SELECT 1",
        "CREATE TRIGGER t AFTER INSERT ON slot BEGIN DELETE FROM slot; END",
        "CREATE TABLE other(a)",
        "ALTER TABLE slot ADD COLUMN more",
        "ALTER TABLE slot RENAME COLUMN kept TO keeps",
        "DROP TABLE slot",
        "DROP TABLE slot; CREATE VIEW slot AS SELECT 1 sequence",
        "PRAGMA writable_schema=ON; UPDATE sqlite_master SET sql=replace(sql,'31','32')",
    };
    for (const char* const change : changes) {
        put_bytes(sound);
        ASSERT_TRUE(run_sql(path(), change)) << change;
        expect_refused(change);
    }
}

TEST_F(CatalogueEnemy, AValueThatNoRowHoldsIsRefusedByWhoeverMeetsIt)
{
    ASSERT_TRUE(test::make_catalogue(path(), 5));
    const test::Bytes sound = test::bytes_of(path());
    const char* const values[] = {
        "sequence=-2",
        "sequence=1000000000",
        "began_us='now'",
        "began_us=1",
        "began_us=9e18",
        "due_us='x'",
        "done=2",
        "reason=zeroblob(3)",

        "clock_trust=zeroblob(40)",
        "reason='a'||char(10)||'b'",
        "reason=CAST(x'ff' AS TEXT)",
        "points=-1",
        "points=1.5",
        "bytes=1<<41",
        "sums=x'00'",
        "sums='0123456789abcdef0123456789abcdef'",
        "pulled_us='x'",
        "kept=4",
        "kept=-1",
        "reason=CAST(zeroblob(5) AS TEXT)",
        "reason=hex(zeroblob(128))",
        "reason=hex(zeroblob(5000))",
    };
    for (const char* const value : values) {
        put_bytes(sound);
        ASSERT_TRUE(run_sql(path(), std::string{"PRAGMA ignore_check_constraints=ON; UPDATE slot SET "} + value +
                                        " WHERE sequence=2"))
            << value;
        expect_refused(value);
    }
}

TEST_F(CatalogueEnemy, LinksPipesAndJournalsAreNotOpened)
{
    ASSERT_TRUE(test::make_catalogue(path(), 5));
    const test::Bytes sound = test::bytes_of(path());
    const std::string elsewhere = folder_.write("elsewhere", sound);
    for (const char* const end : {"", "-wal", "-shm"}) {
        put_bytes(sound);
        std::filesystem::remove(path() + end);
        std::filesystem::create_symlink(elsewhere, path() + end);
        expect_refused(end);
        EXPECT_EQ(test::bytes_of(elsewhere), sound);
        std::filesystem::remove(path() + end);
        ASSERT_EQ(mkfifo((path() + end).c_str(), 0600), 0);
        expect_refused(end); // and does not wait for a writer
        std::filesystem::remove(path() + end);
    }
    put_bytes(sound);
    folder_.write("c.sqlite-journal", "names a file to be deleted");
    expect_refused("-journal");
    EXPECT_TRUE(std::filesystem::exists(path() + "-journal"));
}

TEST_F(CatalogueEnemy, ATreeThatLeadsRoundEndsTheWalk)
{
    ASSERT_TRUE(test::make_catalogue(path(), 120));
    test::Bytes bytes = test::bytes_of(path());
    // SQLite's file format, 1.6: page 2 is an inner node; behind 12 bytes of head come the places of its cells, each of
    // which begins with the number of a page below. The second one is made to name the first one's page again.
    constexpr std::size_t kPage = 4096;
    ASSERT_EQ(bytes[kPage], 0x05);
    ASSERT_GE(bytes[kPage + 4], 2);
    const auto cell = [&](std::size_t i) {
        const std::size_t at = kPage + 12 + 2 * i;
        return kPage + static_cast<std::size_t>(bytes[at] << 8 | bytes[at + 1]);
    };
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(cell(0)), 4,
                bytes.begin() + static_cast<std::ptrdiff_t>(cell(1)));
    put_bytes(bytes);
    const Status status = Catalogue::open(path(), Access::kRead).status();
    EXPECT_EQ(status.fault(), Fault::kBadData);
    EXPECT_NE(std::string(status.message()).find("out of order"), std::string::npos) << status.message();
    expect_refused("a tree that leads round");
}

TEST_F(CatalogueEnemy, CutAndFlippedBytesAreSentencesNeverCrashes)
{
    ASSERT_TRUE(test::make_catalogue(path(), 120));
    const test::Bytes sound = test::bytes_of(path());
    int refused = 0;
    const auto judge = [&](const test::Bytes& bytes, const std::string& what) {
        put_bytes(bytes);
        for (const Access access : {Access::kRead, Access::kWrite}) {
            const Status status = ask_everything(path(), access);
            refused += status.ok() ? 0 : 1;
            EXPECT_TRUE(status.ok() || status.fault() == Fault::kBadData || status.fault() == Fault::kIoError)
                << what << ": " << status.message();
        }
    };
    for (std::size_t part = 1; part < 40; ++part)
        judge(test::Bytes(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(sound.size() * part / 40)),
              "cut " + std::to_string(part));
    EXPECT_EQ(refused, 2 * 39);
    std::mt19937 random{5};
    for (int i = 0; i < 200; ++i) {
        test::Bytes bytes = sound;
        const std::size_t place = random() % (i % 2 == 0 ? 200 : bytes.size());
        bytes[place] = static_cast<std::uint8_t>(bytes[place] ^ (1U << random() % 8));
        judge(bytes, "byte " + std::to_string(place));
    }
    EXPECT_GT(refused, 2 * 39 + 60);
}

} // namespace
} // namespace dicot
