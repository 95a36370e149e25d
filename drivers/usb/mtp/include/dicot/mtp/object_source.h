// What the responder shows: a tree of folders and files that somebody else keeps.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/base/short_text.h"
#include "dicot/base/status.h"
#include "dicot/mtp/snapshot_note.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot::mtp {

/// Names one object for good: in every session, after every start. 0 is none.
using Handle = std::uint32_t;
inline constexpr Handle kRoot = 0; ///< the parent of what stands at the top

struct Object
{
    Handle handle = 0;
    Handle parent = kRoot;
    bool folder = false;
    std::uint64_t bytes = 0;  ///< of a file
    std::int64_t made_us = 0; ///< since 1970, UTC
    ShortText<63> name;
};

/// As the host shows it.
struct Shelf
{
    ShortText<63> label;
    std::uint64_t total_bytes = 0, free_bytes = 0;
};

/// Never changes what it shows by itself: refresh() does, between two requests. All calls from one thread; none takes
/// memory from the heap but what was lent.
class ObjectSource
{
public:
    virtual ~ObjectSource() = default;

    virtual Result<Shelf> shelf() = 0;
    /// What stands directly in `parent`, in ascending order of handles, until `visit` returns false. Fault::kNoInput:
    /// no such folder.
    virtual Status children(Handle parent, FunctionRef<bool(Handle)> visit) = 0;
    /// Everything, folders before what stands in them.
    virtual Status all(FunctionRef<bool(Handle)> visit) = 0;
    /// Fault::kNoInput: not there, or not any more.
    virtual Result<Object> find(Handle handle) = 0;
    /// Of a file, from `offset` on; fewer bytes only at its end. Fault::kNoInput: it has gone since; kIoError.
    virtual Status read(Handle handle, std::uint64_t offset, std::span<std::byte> into, std::size_t& got) = 0;

    /// Looks whether something came or went, and tells it; `changed` may be called many times.
    struct Change
    {
        Handle handle;
        bool added; ///< false: gone
    };
    virtual Status refresh(FunctionRef<void(const Change&)> changed) = 0;

    /// For dicot pull: complete snapshots from number `first` on, in ascending order, until `visit` returns false.
    virtual Status snapshots(std::int64_t first, FunctionRef<bool(const SnapshotNote&)> visit) = 0;
    /// Fault::kUsage: not allowed by configuration; kNoInput, kBadData: as Store::mark_pulled(); kTryAgain: a slot is
    /// under way.
    virtual Status mark_pulled(std::span<const PulledNote> pulled) = 0;
    /// Fault::kUsage: not allowed by configuration, or the rules say no (the sentence says which); kOsError: this user
    /// may not set the clock.
    virtual Status offer_time(const TimeOffer& offer) = 0;
};

} // namespace dicot::mtp
