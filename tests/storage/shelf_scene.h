// A shelf over a real store, and what a host would know of it.
#pragma once

#include "passing_medium.h"
#include "store_scene.h"

#include "dicot/base/utc_time.h"
#include "dicot/shelf/snapshot_shelf.h"

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace dicot::test {

inline std::string name_of(const SnapshotName& name)
{
    return folder_of(name.sequence, name.began_us).c_str();
}

/// Every snapshot in its place, as the names on the disk have it.
inline std::set<std::string> folders_in(const std::string& root)
{
    namespace fs = std::filesystem;
    std::set<std::string> folders;
    for (const auto& day : fs::directory_iterator(root))
        if (day.is_directory() && day.path().filename().string().starts_with("20"))
            for (const auto& snapshot : fs::directory_iterator(day))
                folders.insert(day.path().filename().string() + "/" + snapshot.path().filename().string());
    return folders;
}

class ShelfScene : public StoreScene
{
protected:
    using Limits = SnapshotShelf::Limits;

    void TearDown() override { shelf_.reset(); }

    SnapshotShelf& open_shelf(const Limits& limits = {64, 16}, Medium* medium = nullptr)
    {
        shelf_.reset();
        if (medium == nullptr) {
            looked_at_ = open_disk_medium(root()).value();
            medium = looked_at_.get();
        }
        memory_.assign(SnapshotShelf::bytes_for(limits) / sizeof(Block) + 1, {});
        shelf_ = std::make_unique<SnapshotShelf>(*medium, limits, std::as_writable_bytes(std::span(memory_)), clock);
        const Status listed = refresh();
        EXPECT_TRUE(listed.ok()) << listed.message();
        return *shelf_;
    }
    SnapshotShelf& shelf() { return *shelf_; }

    std::vector<std::string> told; ///< by the last refresh: "+2026-06-01", "-2026-06-01/000001_..."
    Status refresh()
    {
        told.clear();
        const Status status = shelf_->refresh([&](const SnapshotShelf::Change& change) {
            const std::string day = utc_day(change.day * 86'400 * kSecond).c_str();
            told.push_back((change.added ? "+" : "-") + (change.snapshot ? name_of(*change.snapshot) : day));
        });
        return status;
    }
    /// Late enough for a clock of two seconds.
    void wait() { now_us_ += 10 * kSecond; }

    std::set<std::string> shown()
    {
        std::set<std::string> names;
        shelf_->snapshots(1, [&](const SnapshotName& name, int) { return names.insert(name_of(name)).second; });
        return names;
    }
    std::string bytes_at(std::int64_t sequence, int member, std::uint64_t offset = 0, std::size_t most = 1000)
    {
        std::string text(most, '\0');
        std::size_t got = 0;
        const Status status = shelf_->read(sequence, member, offset, std::as_writable_bytes(std::span(text)), got);
        text.resize(got);
        return status.ok() ? text : std::string("! ") + status.message();
    }

private:
    struct alignas(64) Block
    {
        std::byte bytes[64];
    };
    static std::int64_t clock() { return now_us_; }
    static inline std::int64_t now_us_ = 0;

    std::vector<Block> memory_;
    std::unique_ptr<Medium> looked_at_;
    std::unique_ptr<SnapshotShelf> shelf_;
};

} // namespace dicot::test
