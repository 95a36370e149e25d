// A store's objects, as a host walks through them.
#pragma once

#include "store_scene.h"

#include "shelf_objects.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace dicot::test {

namespace fs = std::filesystem;
using app::ShelfObjects;
using app::ShelfSettings;
using mtp::Handle;

inline constexpr std::int64_t kDay = 86'400 * kSecond;

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

} // namespace dicot::test
