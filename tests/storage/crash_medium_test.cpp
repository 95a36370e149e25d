// The simulated card itself: what it must keep, what it may lose, and that it does lose it.
#include "crash_medium.h"
#include "crash_vfs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <set>
#include <string>

#include <sqlite3.h>

using namespace dicot;
using namespace dicot::test;

namespace {

std::span<const std::byte> bytes_in(const std::string& text)
{
    return std::as_bytes(std::span{text});
}

void write_file(CrashMedium& card, const char* path, const std::string& text)
{
    Medium::File file = -1;
    ASSERT_EQ(card.create(path, file).number(), 0);
    ASSERT_EQ(card.write(file, bytes_in(text)).number(), 0);
    ASSERT_EQ(card.close(file).number(), 0);
}

/// "-": there is no such file.
std::string text_of(const CardState& state, const char* path)
{
    const int node = state.find(path);
    if (node < 0)
        return "-";
    const CardBytes& bytes = state.nodes[static_cast<std::size_t>(node)].bytes;
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// What is found under `path` after power loss at the end, for many seeds.
std::set<std::string> outcomes(const CrashMedium& card, Cut::Mode mode, const char* path, std::size_t until = 1000)
{
    std::set<std::string> seen;
    for (unsigned seed = 0; seed < 100; ++seed)
        seen.insert(
            text_of(surviving(card.start(), card.log(), {mode, std::min(until, card.log().size()), seed}), path));
    return seen;
}

using Texts = std::set<std::string>;
constexpr auto kInOrder = Cut::Mode::kInOrder;
constexpr auto kSubset = Cut::Mode::kSubset;
constexpr auto kTorn = Cut::Mode::kTorn;

TEST(CrashMedium, loses_what_is_not_synced_in_every_way)
{
    CrashMedium card;
    write_file(card, "f", "abc");
    EXPECT_EQ(outcomes(card, kInOrder, "f"), (Texts{"abc"}));
    EXPECT_EQ(outcomes(card, kInOrder, "f", 1), (Texts{""}));
    EXPECT_EQ(outcomes(card, kInOrder, "f", 0), (Texts{"-"}));
    EXPECT_EQ(outcomes(card, kSubset, "f"), (Texts{"-", "", std::string(3, '\0'), "abc"}));
}

TEST(CrashMedium, keeps_what_is_synced)
{
    CrashMedium card;
    write_file(card, "f", "abc");
    ASSERT_TRUE(card.sync_all().ok());
    ASSERT_TRUE(card.rename("f", "g").ok());
    for (const auto mode : {kInOrder, kSubset, kTorn}) {
        EXPECT_EQ(outcomes(card, mode, "f", 3), (mode == kInOrder ? Texts{"abc"} : Texts{"-", "abc"}));
        EXPECT_EQ(outcomes(card, mode, "g", 3), (mode == kInOrder ? Texts{"-"} : Texts{"-", "abc"}));
    }
    ASSERT_TRUE(card.sync_folder("").ok());
    EXPECT_EQ(outcomes(card, kSubset, "g"), (Texts{"abc"}));
    EXPECT_EQ(outcomes(card, kSubset, "f"), (Texts{"-"}));
}

TEST(CrashMedium, a_sync_on_its_way_promises_nothing)
{
    CrashMedium card;
    write_file(card, "f", "abc");
    ASSERT_TRUE(card.sync_all().ok());
    EXPECT_EQ(outcomes(card, kSubset, "f", 2).count("-"), 1U);
    EXPECT_EQ(outcomes(card, kSubset, "f", 3), (Texts{"abc"}));
}

TEST(CrashMedium, a_synced_folder_keeps_names_without_their_data)
{
    CrashMedium card;
    ASSERT_TRUE(card.make_folder("day").ok());
    ASSERT_TRUE(card.sync_folder("").ok());
    write_file(card, "day/f", "abc");
    ASSERT_TRUE(card.sync_folder("day").ok());
    EXPECT_EQ(outcomes(card, kSubset, "day/f"), (Texts{"", std::string(3, '\0'), "abc"}));
    ASSERT_TRUE(card.sync_file(card.find_file("day/f")).ok());
    EXPECT_EQ(outcomes(card, kSubset, "day/f"), (Texts{"abc"}));
}

TEST(CrashMedium, a_synced_file_may_still_have_no_name)
{
    CrashMedium card;
    write_file(card, "f", "abc");
    ASSERT_TRUE(card.sync_file(card.find_file("f")).ok());
    EXPECT_EQ(outcomes(card, kSubset, "f"), (Texts{"-", "abc"}));
}

TEST(CrashMedium, a_rename_is_whole_and_the_same_name_keeps_its_order)
{
    CrashMedium card;
    write_file(card, "f", "old");
    ASSERT_TRUE(card.sync_all().ok());
    ASSERT_TRUE(card.rename("f", "g").ok());
    write_file(card, "f", "new");
    ASSERT_TRUE(card.sync_file(card.find_file("f")).ok());
    for (unsigned seed = 0; seed < 100; ++seed) {
        const CardState state = surviving(card.start(), card.log(), {kSubset, card.log().size(), seed});
        const std::string f = text_of(state, "f");
        const std::string g = text_of(state, "g");
        EXPECT_TRUE((f == "old" && g == "-") || (g == "old" && (f == "-" || f == "new"))) << f << ' ' << g;
    }
}

TEST(CrashMedium, a_torn_write_ends_at_a_sector_and_harms_nothing_beside_it)
{
    CrashMedium card;
    const std::string before(700, 'a');
    const std::string behind(1500, 'b');
    write_file(card, "f", before);
    ASSERT_TRUE(card.sync_all().ok());
    const int node = card.find_file("f");
    ASSERT_TRUE(card.write_at(node, before.size(), bytes_in(behind)).ok());
    Texts seen = outcomes(card, kTorn, "f", card.log().size() - 1);
    for (const std::string& text : seen) {
        EXPECT_EQ(text.substr(0, 700), before);
        const std::size_t damaged = std::min(text.find_first_not_of('b', 700), text.size());
        EXPECT_TRUE(damaged % 512 == 0 || damaged == 700 || damaged == 2200 || damaged == text.size() || damaged > 1024)
            << damaged;
    }
    EXPECT_GT(seen.size(), 5U);
    EXPECT_EQ(seen.count(before + behind), 1U);
}

TEST(CrashMedium, fails_at_the_operation_that_was_named_and_leaves_part_of_a_write)
{
    CrashMedium card;
    card.set_fault({ENOSPC, 1, false});
    Medium::File file = -1;
    ASSERT_TRUE(card.create("f", file).ok());
    EXPECT_EQ(card.write(file, bytes_in(std::string(100, 'x'))).number(), ENOSPC);
    EXPECT_TRUE(card.write(file, bytes_in(std::string(1, 'y'))).ok());
    EXPECT_EQ(card.struck(), 1);
    EXPECT_EQ(text_of(card.now(), "f"), std::string(50, 'x') + "y");
    card.set_fault({EROFS, 0, true});
    EXPECT_EQ(card.make_folder("g").number(), EROFS);
    EXPECT_EQ(card.remove_file("f").number(), EROFS);
    EXPECT_TRUE(card.sync_all().ok());
    card.set_fault({EIO, 0, true});
    EXPECT_EQ(card.sync_all().number(), EIO);
    EntryKind kind{};
    EXPECT_EQ(card.kind_of("f", kind).number(), EIO);
}

TEST(CrashMedium, is_full_when_its_blocks_are)
{
    CrashMedium card;
    card.set_capacity(4096 * 4); // one of them for the root
    write_file(card, "f", std::string(5000, 'x'));
    Medium::File file = -1;
    ASSERT_TRUE(card.create("g", file).ok());
    EXPECT_EQ(card.write(file, bytes_in(std::string(5000, 'y'))).number(), ENOSPC);
    EXPECT_EQ(text_of(card.now(), "g").size(), 4096U);
    MediumSpace space;
    ASSERT_TRUE(card.space(space).ok());
    EXPECT_EQ(space.free_bytes, 0U);
    EXPECT_EQ(card.make_folder("day").number(), ENOSPC);
    ASSERT_TRUE(card.remove_file("f").ok());
    EXPECT_TRUE(card.make_folder("day").ok());
}

// SQLite keeps its own promises on this card, or the card would be no judge of anybody.

struct Database
{
    sqlite3* handle = nullptr;
    explicit Database(const char* pragmas)
    {
        constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
        EXPECT_EQ(sqlite3_open_v2("a.sqlite", &handle, kFlags, CrashVfs::kName), SQLITE_OK);
        EXPECT_TRUE(run(pragmas));
    }
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;
    ~Database() { sqlite3_close(handle); }
    bool run(const std::string& words) const
    {
        return sqlite3_exec(handle, words.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK;
    }
    std::string ask(const char* words) const
    {
        std::string answer;
        const auto take = [](void* into, int, char** values, char**) {
            *static_cast<std::string*>(into) = values[0] == nullptr ? "" : values[0];
            return 0;
        };
        if (sqlite3_exec(handle, words, take, &answer, nullptr) != SQLITE_OK)
            return std::string{"failed: "} + sqlite3_errmsg(handle);
        return answer;
    }
};

/// How many crashes lost an acknowledged row or damaged the file. `forgets`: the card syncs no data.
int faults_of_sqlite(const char* pragmas, bool forgets)
{
    CrashVfs vfs;
    CrashMedium card;
    vfs.use(card);
    std::vector<std::size_t> acknowledged;
    {
        const Database database{pragmas};
        EXPECT_TRUE(database.run("CREATE TABLE t(n INTEGER PRIMARY KEY, b BLOB)"));
        for (int n = 1; n <= 12; ++n) {
            EXPECT_TRUE(database.run("INSERT INTO t VALUES(" + std::to_string(n) + ", randomblob(700))"));
            acknowledged.push_back(card.log().size());
            EXPECT_TRUE(n != 6 || database.run("DELETE FROM t WHERE n < 3"));
        }
    }
    std::vector<Change> log = card.log();
    for (Change& change : log) {
        if (forgets && change.kind == Change::Kind::kSyncFile)
            change.kind = Change::Kind::kNothing;
    }
    int faults = 0;
    for (std::size_t at = 0; at <= log.size(); ++at) {
        for (unsigned seed = 0; seed < 4; ++seed) {
            CrashMedium found{surviving(card.start(), log, {seed % 2 == 0 ? kSubset : kTorn, at, seed})};
            vfs.use(found);
            const Database database{""};
            const auto rows = std::count_if(acknowledged.begin(), acknowledged.end(), [&](auto k) { return k <= at; });
            const bool whole = database.ask("PRAGMA integrity_check") == "ok";
            const std::string last = rows == 0 ? "" : database.ask("SELECT max(n) FROM t");
            faults += !whole || (rows != 0 && (last.empty() || last[0] == 'f' || std::stol(last) < rows));
        }
    }
    return faults;
}

TEST(CrashVfs, sqlite_keeps_every_acknowledged_row)
{
    EXPECT_EQ(faults_of_sqlite("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA wal_autocheckpoint=4", false),
              0);
    EXPECT_EQ(faults_of_sqlite("PRAGMA journal_mode=DELETE; PRAGMA synchronous=EXTRA", false), 0);
}

TEST(CrashVfs, sqlite_loses_rows_where_it_does_not_sync_or_the_card_forgets)
{
    EXPECT_GT(faults_of_sqlite("PRAGMA journal_mode=WAL; PRAGMA synchronous=OFF; PRAGMA wal_autocheckpoint=4", false),
              0);
    EXPECT_GT(faults_of_sqlite("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA wal_autocheckpoint=4", true),
              0);
    EXPECT_GT(faults_of_sqlite("PRAGMA journal_mode=DELETE; PRAGMA synchronous=EXTRA", true), 0);
}

} // namespace
