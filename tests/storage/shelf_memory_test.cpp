// What showing the store takes from the heap: nothing but what was lent.
#include "shelf_objects_scene.h"

#include "dicot/os/heap_gate.h"
#include "dicot/os/memory_block.h"
#include "dicot/os/memory_reserve.h"

#include "shelf_marks.h"

#include <cstdio>

namespace dicot::test {
namespace {

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
