// Objects that only their names and sizes are kept of: what is in them follows from handle and place.
#pragma once

#include "dicot/mtp/object_source.h"

#include <algorithm>
#include <map>
#include <vector>

namespace dicot::test {

class MemoryShelf final : public mtp::ObjectSource
{
public:
    void folder(mtp::Handle handle, mtp::Handle parent, std::string_view name, std::int64_t made_us = 0)
    {
        objects_[handle] = {handle, parent, true, 0, made_us, name};
    }
    void file(mtp::Handle handle, mtp::Handle parent, std::string_view name, std::uint64_t bytes,
              std::int64_t made_us = 0)
    {
        objects_[handle] = {handle, parent, false, bytes, made_us, name};
    }
    void remove(mtp::Handle handle) { objects_.erase(handle); }

    static std::byte content(mtp::Handle handle, std::uint64_t at)
    {
        return static_cast<std::byte>((at * 0x9E3779B97F4A7C15u + handle) >> 56);
    }
    static std::vector<std::byte> content(mtp::Handle handle, std::uint64_t at, std::size_t bytes)
    {
        std::vector<std::byte> all(bytes);
        for (std::size_t i = 0; i < bytes; ++i)
            all[i] = content(handle, at + i);
        return all;
    }

    std::vector<Change> changes; ///< told by the next refresh()
    std::vector<mtp::SnapshotNote> notes;
    std::vector<mtp::PulledNote> marked;
    std::vector<mtp::TimeOffer> offered;
    Fault mark_fault = Fault::kOk, offer_fault = Fault::kOk;
    Fault read_fault = Fault::kOk;
    std::uint64_t read_fault_at = 0;     ///< from this byte on
    std::uint64_t prune_at = UINT64_MAX; ///< a file is gone once somebody reads beyond this byte of it
    std::uint64_t calls = 0;             ///< of all kinds
    int refreshed = 0;

    Result<mtp::Shelf> shelf() override
    {
        ++calls;
        return mtp::Shelf{"bench 3", 64'000'000'000, 5'000'000'000};
    }
    Status children(mtp::Handle parent, FunctionRef<bool(mtp::Handle)> visit) override
    {
        ++calls;
        if (parent != mtp::kRoot && (!objects_.count(parent) || !objects_[parent].folder))
            return failure(Fault::kNoInput, "no folder %u", parent);
        for (const auto& [handle, object] : objects_)
            if (object.parent == parent && !visit(handle))
                break;
        return {};
    }
    Status all(FunctionRef<bool(mtp::Handle)> visit) override
    {
        ++calls;
        for (const bool folders : {true, false})
            for (const auto& [handle, object] : objects_)
                if (object.folder == folders && !visit(handle))
                    return {};
        return {};
    }
    Result<mtp::Object> find(mtp::Handle handle) override
    {
        ++calls;
        const auto found = objects_.find(handle);
        if (found == objects_.end())
            return failure(Fault::kNoInput, "no object %u", handle);
        return found->second;
    }
    Status read(mtp::Handle handle, std::uint64_t offset, std::span<std::byte> into, std::size_t& got) override
    {
        ++calls;
        got = 0;
        const auto found = objects_.find(handle);
        if (found == objects_.end())
            return failure(Fault::kNoInput, "no object %u", handle);
        if (read_fault != Fault::kOk && offset + into.size() > read_fault_at)
            return failure(read_fault, "as asked for");
        if (offset + into.size() > prune_at) {
            objects_.erase(found);
            return failure(Fault::kNoInput, "no object %u", handle);
        }
        const std::uint64_t left = offset < found->second.bytes ? found->second.bytes - offset : 0;
        got = static_cast<std::size_t>(std::min<std::uint64_t>(left, into.size()));
        for (std::size_t i = 0; i < got; ++i)
            into[i] = content(handle, offset + i);
        return {};
    }
    Status refresh(FunctionRef<void(const Change&)> changed) override
    {
        ++refreshed;
        for (const Change& one : std::exchange(changes, {}))
            changed(one);
        return {};
    }
    Status snapshots(std::int64_t first, FunctionRef<bool(const mtp::SnapshotNote&)> visit) override
    {
        ++calls;
        for (const mtp::SnapshotNote& note : notes)
            if (note.sequence >= first && !visit(note))
                break;
        return {};
    }
    Status mark_pulled(std::span<const mtp::PulledNote> pulled) override
    {
        ++calls;
        marked.insert(marked.end(), pulled.begin(), pulled.end());
        return mark_fault == Fault::kOk ? Status{} : failure(mark_fault, "as asked for");
    }
    Status offer_time(const mtp::TimeOffer& offer) override
    {
        ++calls;
        offered.push_back(offer);
        return offer_fault == Fault::kOk ? Status{} : failure(offer_fault, "as asked for");
    }

private:
    std::map<mtp::Handle, mtp::Object> objects_;
};

} // namespace dicot::test
