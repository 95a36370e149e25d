// Power loss while a damaged snapshot is moved aside: it is evidence, and nothing of it may get lost.
#include "crash_cases.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <set>

using namespace dicot;
using namespace dicot::test;

namespace {

constexpr std::int64_t kDayUs = 86'400'000'000;
constexpr std::int64_t kNoonUs = 1'780'315'200'000'000; ///< 2026-06-01T12:00:00Z

std::unique_ptr<Store> opened(CrashMedium& card, CrashVfs& vfs)
{
    vfs.use(card);
    auto store = Store::open(card, StoreRules{0, Prune::kNever}, Store::kCatalogueName, CrashVfs::kName);
    EXPECT_TRUE(store.ok()) << store.status().message();
    return store.ok() ? std::move(store).value() : nullptr;
}

void repair(Store& store)
{
    const auto report = store.verify(
        true, [](const Finding&) {}, [](int, int) {});
    EXPECT_TRUE(report.ok()) << report.status().message();
}

TEST(DamagedSnapshot, is_in_quarantine_as_it_was_found_however_often_the_power_went)
{
    CrashScene scene;
    CrashMedium young;
    Told damaged;
    Told sound;
    {
        const auto store = opened(young, scene.vfs());
        ASSERT_NE(store, nullptr);
        ASSERT_TRUE(store_snapshot(young, *store, kNoonUs, 1, 500, damaged).ok());
        ASSERT_TRUE(store_snapshot(young, *store, kNoonUs + kDayUs, 2, 500, sound).ok());
    }
    const int picture = young.find_file((damaged.folder + "/left.jpg").c_str());
    ASSERT_GE(picture, 0);
    ASSERT_TRUE(young.write_at(picture, 0, std::as_bytes(std::span{"X", 1})).ok());
    const CardState before = young.now();
    CrashMedium card{before};
    repair(*opened(card, scene.vfs()));

    const std::string aside = "quarantine" + damaged.folder.substr(damaged.folder.find('/'));
    const CardBytes bytes = before.nodes[static_cast<std::size_t>(picture)].bytes;
    std::set<std::uint64_t> seen;
    for (std::size_t at = 0; at <= card.log().size(); ++at) {
        for (unsigned seed = 0; seed < 24; ++seed) {
            const Cut cut{Cut::Mode::kSubset, at, seed};
            CrashMedium found{surviving(before, card.log(), cut)};
            if (!seen.insert(found.start().fingerprint()).second)
                continue;
            const auto store = opened(found, scene.vfs());
            ASSERT_NE(store, nullptr) << cut.text();
            repair(*store);
            EXPECT_LT(found.now().find(damaged.folder), 0) << cut.text();
            const int moved = found.find_file((aside + "/left.jpg").c_str());
            ASSERT_GE(moved, 0) << cut.text() << ": it is gone";
            EXPECT_EQ(found.now().nodes[static_cast<std::size_t>(moved)].bytes, bytes) << cut.text();
            const auto row = store->catalogue().find(damaged.sequence);
            ASSERT_TRUE(row.ok() && row.value()) << cut.text();
            EXPECT_EQ(row.value()->kept, Kept::kQuarantined) << cut.text();
            const auto other = store->catalogue().find(sound.sequence);
            ASSERT_TRUE(other.ok() && other.value()) << cut.text();
            EXPECT_EQ(other.value()->kept, Kept::kHere) << cut.text();
            EXPECT_GE(found.now().find(sound.folder), 0) << cut.text();
        }
    }
    std::printf("%zu changes, %zu states\n", card.log().size(), seen.size());
    EXPECT_GT(seen.size(), 5U);
}

} // namespace
