// Catalogues that several processes use, and whose writer dies.
#include "catalogue_cases.h"
#include "temp_folder.h"

#include "dicot/catalogue/catalogue.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>

namespace dicot {
namespace {

using Access = Catalogue::Access;
using test::slot_row;

std::int64_t rows_in(const std::string& path)
{
    const auto catalogue = Catalogue::open(path, Access::kRead);
    if (!catalogue.ok())
        return -catalogue.status().exit_code();
    const Result<SlotTotals> totals = catalogue.value()->totals();
    return totals.ok() ? totals.value().slots : -totals.status().exit_code();
}

TEST(CatalogueBeside, AReaderSeesWhatAnotherProcessPutsAndHoldsNobodyUp)
{
    const test::TempFolder folder;
    const std::string path = folder.path("c.sqlite");
    const auto writer = Catalogue::open(path, Access::kWrite);
    ASSERT_TRUE(writer.ok()) << writer.status().message();
    ASSERT_TRUE(test::put_rows(*writer.value(), 1, 10).ok());
    int told[2];
    int asked[2];
    ASSERT_EQ(pipe(told), 0);
    ASSERT_EQ(pipe(asked), 0);
    const pid_t reader = fork();
    if (reader == 0) {
        const auto catalogue = Catalogue::open(path, Access::kRead);
        if (!catalogue.ok())
            _exit(catalogue.status().exit_code());
        std::int64_t seen = 0;
        char word = 0;
        // It stops in the middle of its rows until the writer has put more: it neither waits nor sees them yet.
        const Status status = catalogue.value()->for_each({}, [&](const SlotRow& row) {
            if (++seen == 5 && (write(told[1], "5", 1) != 1 || read(asked[0], &word, 1) != 1))
                _exit(91);
            return row == slot_row(row.sequence);
        });
        const bool right = status.ok() && seen == 10 && catalogue.value()->last_sequence().value() == 500;
        _exit(right ? 0 : 92);
    }
    char word = 0;
    ASSERT_EQ(read(told[0], &word, 1), 1);
    ASSERT_TRUE(test::put_rows(*writer.value(), 11, 500).ok());
    for (std::int64_t i = 1; i <= 300; ++i) // across checkpoints
        ASSERT_TRUE(writer.value()->put(slot_row(i)).ok());
    ASSERT_TRUE(writer.value()->sync().ok());
    ASSERT_EQ(write(asked[1], "w", 1), 1);
    int status = 0;
    waitpid(reader, &status, 0);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
    for (const int end : {told[0], told[1], asked[0], asked[1]})
        close(end);
}

TEST(CatalogueBeside, WhatAKilledWriterPutIsThereAndWhatItHadBegunIsNot)
{
    const test::TempFolder folder;
    const std::string path = folder.path("c.sqlite");
    ASSERT_EQ(test::run_apart([&] {
                  const auto catalogue = Catalogue::open(path, Access::kWrite);
                  if (!catalogue.ok() || !test::put_rows(*catalogue.value(), 1, 20).ok() ||
                      !catalogue.value()->begin().ok())
                      return 1;
                  for (std::int64_t i = 21; i <= 4000; ++i) // more than stays in memory: pages are in the log
                      if (!catalogue.value()->put(slot_row(i)).ok())
                          return 2;
                  std::raise(SIGKILL);
                  return 3;
              }),
              -SIGKILL);
    ASSERT_GT(std::filesystem::file_size(path + "-wal"), 100'000U);
    EXPECT_EQ(test::run_apart([&] { return rows_in(path) == 20 ? 0 : 1; }), 0) << "a reader comes first";
    EXPECT_EQ(test::run_apart([&] {
                  const auto catalogue = Catalogue::open(path, Access::kWrite);
                  return catalogue.ok() && catalogue.value()->last_sequence().value() == 20 &&
                                 catalogue.value()->put(slot_row(21)).ok() && catalogue.value()->check().ok()
                             ? 0
                             : 1;
              }),
              0);
    EXPECT_EQ(rows_in(path), 21);
}

TEST(CatalogueBeside, ASecondWriterIsAskedToTryAgain)
{
    const test::TempFolder folder;
    const std::string path = folder.path("c.sqlite");
    const auto first = Catalogue::open(path, Access::kWrite);
    ASSERT_TRUE(first.ok());
    ASSERT_TRUE(first.value()->begin().ok());
    ASSERT_TRUE(first.value()->put(slot_row(1)).ok());
    const auto second = Catalogue::open(path, Access::kWrite);
    ASSERT_TRUE(second.ok()) << second.status().message();
    const Status refused = second.value()->put(slot_row(2)); // after three seconds
    EXPECT_EQ(refused.fault(), Fault::kTryAgain) << refused.message();
    ASSERT_TRUE(first.value()->commit().ok());
    EXPECT_TRUE(second.value()->put(slot_row(2)).ok());
    EXPECT_EQ(first.value()->totals().value().slots, 2);
}

TEST(CatalogueBeside, NothingIsMadeForAReader)
{
    const test::TempFolder folder;
    const auto missing = Catalogue::open(folder.path("none.sqlite"), Access::kRead);
    EXPECT_EQ(missing.status().fault(), Fault::kNoInput) << missing.status().message();
    EXPECT_EQ(folder.files(), 0U);
    const auto no_folder = Catalogue::open(folder.path("no/c.sqlite"), Access::kWrite);
    EXPECT_EQ(no_folder.status().fault(), Fault::kIoError) << no_folder.status().message();
}

TEST(CatalogueBeside, AFileThatMayNotBeWrittenIsReadOrRefused)
{
    const test::TempFolder folder;
    const std::string path = folder.path("c.sqlite");
    ASSERT_TRUE(test::make_catalogue(path, 30));
    std::filesystem::permissions(path, std::filesystem::perms::owner_read);
    std::filesystem::permissions(folder.path("."),
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    const bool as_root = geteuid() == 0; // for whom permissions mean nothing: become nobody
    const int code = test::run_apart([&] {
        if (as_root && (chown(path.c_str(), 65534, 65534) != 0 || chown(folder.path(".").c_str(), 65534, 65534) != 0 ||
                        setgid(65534) != 0 || setuid(65534) != 0))
            return 90;
        const auto writer = Catalogue::open(path, Access::kWrite);
        const std::int64_t rows = rows_in(path);
        std::fprintf(stderr, "for writing: %s; rows when read: %lld\n", writer.status().message(),
                     static_cast<long long>(rows));
        if (writer.status().fault() != Fault::kIoError)
            return 91;
        return rows == 30 || rows == -static_cast<int>(Fault::kIoError) ? 0 : 92;
    });
    std::filesystem::permissions(folder.path("."), std::filesystem::perms::owner_all);
    EXPECT_EQ(code, 0);
}

} // namespace
} // namespace dicot
