// What hosts see of a store: all that is complete, nothing else, and each change once.
#include "shelf_scene.h"

#include <algorithm>
#include <fstream>
#include <map>

namespace dicot::test {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kDay = 86'400 * kSecond;
using Names = std::vector<std::string>;

class Shelf : public ShelfScene
{
};

TEST_F(Shelf, ShowsEachFileOfEachSnapshotAsItLiesOnTheDisk)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon, std::string(5000, 'c')).ok());
    ASSERT_TRUE(miss_one(store, kNoon + kSecond, "no camera").ok());
    ASSERT_TRUE(store_one(store, kNoon + kDay).ok());
    SnapshotShelf& shelf = open_shelf();
    EXPECT_EQ(shown(), folders_in(root()));
    std::map<std::int64_t, ShortText<64>> sums;
    for (const SlotRow& row : rows_of(store.catalogue()))
        sums[row.sequence] = row.sums;
    int looked_at = 0;
    shelf.snapshots(1, [&](const SnapshotName& name, int count) {
        const SnapshotFiles files = *shelf.files(name.sequence).value();
        EXPECT_EQ(files.count, count);
        EXPECT_EQ(hex_of(files.sums).data(), std::string(sums[name.sequence].c_str()));
        const std::string folder = name_of(name);
        std::uint64_t bytes = 0;
        for (const auto& entry : fs::directory_iterator(at(folder)))
            bytes += entry.file_size();
        EXPECT_EQ(files.bytes(), bytes);
        for (int k = 0; k < files.count; ++k) {
            const StoredFile& file = files.files[static_cast<std::size_t>(k)];
            const std::string path = folder + "/" + file.name.c_str();
            EXPECT_EQ(file.bytes, fs::file_size(at(path)));
            EXPECT_EQ(bytes_at(name.sequence, k, 0, 10'000), text_at(path));
            EXPECT_EQ(bytes_at(name.sequence, k, 3, 4), text_at(path).substr(3, 4));
        }
        EXPECT_EQ(bytes_at(name.sequence, SnapshotShelf::kSumsMember), text_at(folder + "/SHA256SUMS"));
        EXPECT_EQ(bytes_at(name.sequence, 0, 1'000'000), "");
        EXPECT_EQ(bytes_at(name.sequence, files.count)[0], '!') << "there is no such file";
        ++looked_at;
        return true;
    });
    EXPECT_EQ(looked_at, 3);
    EXPECT_EQ(shelf.latest_before(kNoon + 2 * kDay), kNoon + kDay);
    EXPECT_EQ(shelf.latest_before(kNoon + kDay), kNoon + kSecond);
    EXPECT_EQ(latest_in_store(medium(), kNoon + kDay).value(), kNoon + kSecond);
    EXPECT_EQ(latest_in_store(medium(), kNoon).value(), std::nullopt);
}

TEST_F(Shelf, ShowsNothingThatIsWrittenDeletedDamagedOrTheStoresOwn)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    ASSERT_TRUE(store_one(store, kNoon + kSecond).ok());
    const std::string first = name_of({1, kNoon});
    fs::copy(at(first), at("leaving/000001_20260601T120000Z"));
    fs::copy(at(first), at("quarantine/000001_20260601T120000Z"));
    ASSERT_TRUE(store.begin({kNoon + 2 * kSecond, {}}).ok());
    ASSERT_TRUE(add_text(store, "cloud.drc", "half").ok());
    open_shelf();
    EXPECT_EQ(shown(), (std::set<std::string>{first, name_of({2, kNoon + kSecond})}));
    std::vector<std::int64_t> days;
    shelf().days([&](std::uint32_t day) { return days.push_back(day), true; });
    EXPECT_EQ(days, std::vector<std::int64_t>{kNoon / kDay});
}

TEST_F(Shelf, AMarkOfAPullIsToldAndIsNoFile)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    open_shelf();
    const int files = shelf().files(1).value()->count;
    EXPECT_FALSE(shelf().files(1).value()->pulled);
    const ShortText<64> sums = rows_of(store.catalogue()).front().sums;
    ASSERT_TRUE(store.mark_pulled(std::vector<Pull>{{1, sums, kNoon}}).ok());
    shelf().forget_files();
    EXPECT_TRUE(shelf().files(1).value()->pulled);
    EXPECT_EQ(shelf().files(1).value()->count, files);
    write_at(name_of({1, kNoon}) + "/PULLED", "of another one\n");
    shelf().forget_files();
    EXPECT_FALSE(shelf().files(1).value()->pulled);
}

TEST_F(Shelf, TellsEachThatCameAndEachThatWentOnceDaysAroundTheirSnapshots)
{
    Store& store = open({.reserve_bytes = 0, .prune = Prune::kAll});
    ASSERT_TRUE(store_one(store, kNoon).ok());
    open_shelf();
    EXPECT_EQ(told, Names{});
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(told, Names{});
    ASSERT_TRUE(store_one(store, kNoon + kSecond).ok());
    ASSERT_TRUE(store_one(store, kNoon + kDay).ok());
    wait();
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(told, (Names{"+" + name_of({2, kNoon + kSecond}), "+2026-06-02", "+" + name_of({3, kNoon + kDay})}));
    ASSERT_TRUE(store.prune({.free_bytes = 0, .older_than_us = kNoon + kDay, .dry_run = false}, [](auto&) {}).ok());
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(told, (Names{"-" + name_of({1, kNoon}), "-" + name_of({2, kNoon + kSecond}), "-2026-06-01"}));
    wait();
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(told, Names{});
    EXPECT_EQ(shown(), folders_in(root()));
}

TEST_F(Shelf, WhatIsPrunedIsReadToTheEndOfTheOpenFileAndThenGone)
{
    Store& store = open({.reserve_bytes = 0, .prune = Prune::kAll});
    const std::string cloud(100'000, 'c');
    ASSERT_TRUE(store_one(store, kNoon, cloud).ok());
    ASSERT_TRUE(store_one(store, kNoon + kDay).ok());
    open_shelf();
    ASSERT_EQ(bytes_at(1, 0, 0, 50'000), cloud.substr(0, 50'000));
    ASSERT_EQ(
        store.prune({.free_bytes = 0, .older_than_us = kNoon + 1, .dry_run = false}, [](auto&) {}).value().removed, 1);
    EXPECT_EQ(bytes_at(1, 0, 50'000, 60'000), cloud.substr(50'000));
    std::size_t got = 1;
    std::byte byte{};
    EXPECT_EQ(shelf().read(1, 1, 0, {&byte, 1}, got).fault(), Fault::kNoInput) << "another file of it";
    EXPECT_EQ(got, 0U);
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(shelf().read(1, 0, 0, {&byte, 1}, got).fault(), Fault::kNoInput);
    EXPECT_EQ(shelf().files(1).status().fault(), Fault::kNoInput);
    for (const auto& open_file : fs::directory_iterator("/proc/self/fd")) {
        std::error_code gone;
        EXPECT_EQ(fs::read_symlink(open_file, gone).string().find("cloud.drc"), std::string::npos)
            << "its room is not given back";
    }
}

TEST_F(Shelf, SizesAndOffsetsHaveMoreThanThirtyTwoBits)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    const std::string path = at(name_of({1, kNoon}) + "/cloud.drc");
    constexpr std::uint64_t kBytes = (std::uint64_t{5} << 30) + 7;
    fs::resize_file(path, kBytes);
    std::fstream(path, std::ios::in | std::ios::out | std::ios::binary).seekp(kBytes - 3).write("end", 3);
    open_shelf();
    EXPECT_EQ(shelf().files(1).value()->files[0].bytes, kBytes);
    EXPECT_EQ(bytes_at(1, 0, kBytes - 3), "end");
    EXPECT_EQ(bytes_at(1, 0, 0, 10), "the points");
    EXPECT_EQ(bytes_at(1, 0, ~std::uint64_t{0} - 5), "");
}

TEST_F(Shelf, TheNewestAreShownWhenThereAreTooMany)
{
    ASSERT_TRUE(store_one(open(), kNoon).ok());
    const std::string one = at(name_of({1, kNoon}));
    const auto folder = [](int k) { return name_of({k, kNoon + k % 6 * kDay + k * kSecond}); };
    const auto folders = [&](int first, int last) {
        std::set<std::string> names;
        for (int k = first; k <= last; ++k)
            names.insert(folder(k));
        return names;
    };
    for (const std::string& name : folders(2, 120)) {
        fs::create_directories(at(name));
        fs::copy(one, at(name));
    }
    open_shelf({20, 16});
    EXPECT_EQ(shown(), folders(101, 120));
    EXPECT_EQ(shelf().hidden().beyond_limits, 100U);
    // Room again: the next older ones come.
    for (const std::string& name : folders(111, 120))
        fs::remove_all(at(name));
    std::set<std::string> known = folders(101, 120);
    for (int k = 0; k < 2; ++k) {
        ASSERT_TRUE(refresh().ok());
        for (const std::string& change : told)
            EXPECT_TRUE(change[0] == '+' ? known.insert(change.substr(1)).second : known.erase(change.substr(1)) == 1);
    }
    EXPECT_EQ(known, folders(91, 110));
    EXPECT_EQ(shown(), known);
    open_shelf({100, 2});
    EXPECT_EQ(shelf().hidden().beyond_limits, 4U) << "days";
    for (const std::string& name : shown())
        EXPECT_GE(name, "2026-06-05");
}

TEST_F(Shelf, ADayIsListedAgainWhenItsStampChangedAndOnceMoreWhenItsClockCouldHaveTicked)
{
    class Counting final : public PassingMedium
    {
    public:
        using PassingMedium::PassingMedium;
        Errno list(const char* path, FunctionRef<bool(const MediumEntry&)> visit) override
        {
            ++lists[path];
            return PassingMedium::list(path, visit);
        }
        Errno stamp(const char* path, FolderStamp& stamp) override
        {
            const Errno outcome = PassingMedium::stamp(path, stamp);
            if (is_frozen)
                stamp = {};
            return outcome;
        }
        std::map<std::string, int> lists;
        bool is_frozen = false;
    };
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    ASSERT_TRUE(store_one(store, kNoon + kDay).ok());
    auto disk = open_disk_medium(root()).value();
    Counting counting(*disk);
    open_shelf({64, 16}, &counting);
    const auto lists = [&](const char* day) { return counting.lists[day]; };
    for (int k = 0; k < 5; ++k)
        ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(lists("2026-06-01"), 1);
    wait();
    for (int k = 0; k < 5; ++k)
        ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(lists("2026-06-01"), 2);
    ASSERT_TRUE(store_one(store, kNoon + kDay + kSecond).ok());
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(lists("2026-06-01"), 2);
    EXPECT_EQ(lists("2026-06-02"), 3);
    EXPECT_EQ(told.size(), 1U);
    // A clock that stands still: what comes after the first look is seen by the second one.
    counting.is_frozen = true;
    ASSERT_TRUE(refresh().ok());
    ASSERT_TRUE(store_one(store, kNoon + 2 * kSecond).ok());
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(told.size(), 0U);
    wait();
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(told, Names{"+" + name_of({4, kNoon + 2 * kSecond})});
}

} // namespace
} // namespace dicot::test
