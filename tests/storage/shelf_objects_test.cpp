// The store as the objects of a host: handles that mean the same for ever, and what a host may do to it.
#include "store_scene.h"

#include "dicot/os/clock.h"
#include "dicot/os/heap_gate.h"
#include "dicot/os/memory_block.h"
#include "dicot/os/memory_reserve.h"
#include "dicot/os/sha256.h"

#include "shelf_marks.h"
#include "shelf_objects.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>

namespace dicot::test {
namespace {

namespace fs = std::filesystem;
using app::ShelfObjects;
using app::ShelfSettings;
using mtp::Handle;

constexpr std::int64_t kDay = 86'400 * kSecond;
constexpr Handle kJune1 = 0x80000000U + 20'605; ///< 2026-06-01 is 56 years, 14 leap days and 151 days after 1970-01-01
static_assert(56 * 365 + 14 + 151 == 20'605);

class Objects : public StoreScene
{
protected:
    void TearDown() override { objects_.reset(); }

    ShelfSettings settings() const
    {
        ShelfSettings settings;
        settings.path = root();
        settings.device = "board-3";
        settings.rules = {.reserve_bytes = 0, .prune = Prune::kPulled, .cause = {}};
        settings.offer_file = at("clock-offer");
        return settings;
    }
    ShelfObjects& look(const ShelfSettings& settings)
    {
        objects_.reset();
        objects_ = ShelfObjects::open(settings).value();
        return *objects_;
    }
    ShelfObjects& look() { return look(settings()); }

    std::vector<Handle> children(Handle parent)
    {
        std::vector<Handle> handles;
        const Status status =
            objects_->children(parent, [&](Handle handle) { return handles.push_back(handle), true; });
        EXPECT_TRUE(status.ok()) << status.message();
        return handles;
    }
    /// "board-3/2026-06-01/000001_.../cloud.drc", as a host puts it together.
    std::string path_of(Handle handle)
    {
        std::string path;
        for (int depth = 0; handle != mtp::kRoot && depth < 5; ++depth) {
            const auto object = objects_->find(handle);
            EXPECT_TRUE(object.ok()) << object.status().message();
            if (!object.ok())
                break;
            path = object.value().name.c_str() + (path.empty() ? "" : "/" + path);
            handle = object.value().parent;
        }
        return path;
    }
    /// What a host has when it has taken everything.
    std::map<std::string, std::string> everything()
    {
        std::map<std::string, std::string> files;
        const Status status = objects_->all([&](Handle handle) {
            const mtp::Object object = objects_->find(handle).value();
            const std::vector<Handle> beside = children(object.parent);
            EXPECT_EQ(std::ranges::count(beside, handle), 1) << object.name.c_str();
            EXPECT_TRUE(std::ranges::is_sorted(beside));
            if (object.folder)
                return true;
            std::string bytes(object.bytes + 10, '\0');
            std::size_t got = 0;
            EXPECT_TRUE(objects_->read(handle, 0, std::as_writable_bytes(std::span(bytes)), got).ok());
            EXPECT_EQ(got, object.bytes);
            bytes.resize(got);
            files[path_of(handle)] = bytes;
            return true;
        });
        EXPECT_TRUE(status.ok());
        return files;
    }
    std::map<std::string, std::string> on_the_disk() const
    {
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(root())) {
            const std::string path = fs::relative(entry.path(), root()).string();
            if (entry.is_regular_file() && path.starts_with("20") && entry.path().filename() != "PULLED")
                files["board-3/" + path] = text_at(path);
        }
        return files;
    }
    std::vector<mtp::SnapshotNote> notes(std::int64_t first = 1)
    {
        std::vector<mtp::SnapshotNote> all;
        EXPECT_TRUE(objects_->snapshots(first, [&](const auto& note) { return all.push_back(note), true; }).ok());
        return all;
    }
    static mtp::PulledNote pulled(const mtp::SnapshotNote& note) { return {note.sequence, note.sums}; }

private:
    std::unique_ptr<ShelfObjects> objects_;
};

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

/// All that a responder may ask, with a heap that is closed for good.
TEST_F(Objects, NothingIsTakenFromTheHeapAfterItIsSealed)
{
    if (!heap_gate::replaces_operator_new())
        GTEST_SKIP() << "sanitizers bring their own operator new";
    Store& store = open();
    for (int k = 0; k < 40; ++k)
        ASSERT_TRUE(store_one(store, kNoon + k * kSecond).ok());
    close();
    const app::ShelfBudget budget = app::shelf_budget({64, 16});
    ShelfSettings small = settings();
    small.limits = {64, 16};
    ShelfObjects& objects = look(small);
    const auto all = notes();
    std::vector<mtp::PulledNote> marks;
    for (const auto& note : all)
        marks.push_back(pulled(note));
    const MemoryBlock pages = MemoryBlock::map(budget.pages).value();
    static MemoryBlock libraries = MemoryBlock::map(std::size_t{64} << 10).value();
    std::size_t objects_seen = 0, notes_seen = 0, changes = 0, got = 0;
    static std::byte bytes[4096];
    Status marked, refreshed;
    {
        const MemoryReserve reserve(pages.bytes());
        heap_gate::seal_for_good(libraries.bytes(), heap_gate::Breach::kCount);
        refreshed = objects.refresh([&](const auto&) { ++changes; });
        marked = objects.mark_pulled(marks);
        (void)objects.all([&](Handle handle) { return (void)objects.find(handle), ++objects_seen, true; });
        (void)objects.read(0x11, 0, bytes, got);
        (void)objects.snapshots(1, [&](const mtp::SnapshotNote& note) { return notes_seen += note.pulled, true; });
        (void)objects.offer_time({kNoon});
        (void)objects.shelf();
        heap_gate::reopen();
        EXPECT_EQ(reserve.used_bytes(), 0U);
        EXPECT_EQ(reserve.refused(), 0U);
        std::printf("pages %zu of %zu\n", reserve.peak_bytes(), budget.pages);
    }
    EXPECT_TRUE(marked.ok()) << marked.message();
    EXPECT_TRUE(refreshed.ok());
    EXPECT_EQ(heap_gate::breaches(), 0U);
    EXPECT_EQ(heap_gate::libraries_heap().refused, 0U);
    std::printf("malloc: %zu bytes at most\n", heap_gate::libraries_heap().peak_bytes);
    EXPECT_EQ(objects_seen, 1U + 1U + 40U * 5U);
    EXPECT_EQ(notes_seen, 40U);
    EXPECT_EQ(got, 10U);
    EXPECT_EQ(changes, 0U);
}

TEST_F(Objects, AnOfficeThatIsTooSmallIsARefusalAndLeavesTheStoreAsItWas)
{
    if (!heap_gate::replaces_operator_new())
        GTEST_SKIP() << "sanitizers bring their own operator new";
    ASSERT_TRUE(store_one(open(), kNoon).ok());
    close();
    look();
    const std::vector<mtp::PulledNote> marks(512, pulled(notes()[0]));
    std::vector<std::byte> office(app::kMarksOfficeBytes);
    const StoreRules rules{.reserve_bytes = 0, .prune = Prune::kPulled, .cause = {}};
    int refused = 0;
    for (std::size_t bytes = 1024; bytes < office.size(); bytes += 4096) {
        const Status status = app::write_marks(root(), rules, marks, std::span(office).first(bytes));
        refused += status.ok() ? 0 : 1;
        if (!status.ok()) {
            EXPECT_EQ(status.fault(), Fault::kOsError) << status.message();
        }
    }
    EXPECT_GT(refused, 0);
    std::printf("512 marks take %d KiB\n", 4 * refused);
    EXPECT_LT(refused * 4096, static_cast<int>(office.size() / 2)) << "no reserve is left";
    EXPECT_EQ(everything(), on_the_disk());
    open();
    EXPECT_EQ(verify().findings, 0);
}

} // namespace
} // namespace dicot::test
