// The store of this board as the objects that a host sees.
#pragma once

#include "clock_offer.h"

#include "../config/config.h"

#include "dicot/mtp/object_source.h"
#include "dicot/os/memory_block.h"
#include "dicot/shelf/snapshot_shelf.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace dicot::app {

/// What ShelfObjects needs for good; all of it is mapped when it is made, but for the last two.
struct ShelfBudget
{
    std::size_t index = 0;     ///< 16 bytes a snapshot
    std::size_t office = 0;    ///< what operator new takes while marks are written
    std::size_t catalogue = 0; ///< SQLite's block: mapped
    std::size_t catalogue_resident = 0;
    std::size_t pages = 0; ///< of MemoryBlock::map() while marks are written: for a MemoryReserve

    std::size_t mapped() const { return index + office + catalogue + pages; }
    std::size_t resident() const { return index + office + catalogue_resident + pages; }
};
ShelfBudget shelf_budget(const SnapshotShelf::Limits& limits = {}) noexcept;

struct ShelfSettings
{
    std::string path;   ///< folder of the board's snapshots (BoardStore::path)
    std::string device; ///< its name, the folder at the top
    OutputConfig output;
    UsbConfig usb;
    SnapshotShelf::Limits limits{};
    std::string offer_file = kClockOfferFile;
};

/// Handles are computed, and so mean the same for ever: 1 the board's folder; 0x80000000 + days since 1970 a day;
/// 16 x number + member what belongs to a snapshot: member 0 its folder, 1 .. 8 the files in the order of SHA256SUMS,
/// 15 SHA256SUMS.
class ShelfObjects final : public mtp::ObjectSource
{
public:
    /// Before the heap is sealed. Reads all names; opens the store for writing once, where marks are allowed and nobody
    /// else writes, so that what SQLite takes at its start is taken. Fault::kNoInput: there is no such folder;
    /// kOsError: no memory; kIoError.
    static Result<std::unique_ptr<ShelfObjects>> open(const ShelfSettings& settings);

    Result<mtp::Shelf> shelf() override;
    Status children(mtp::Handle parent, FunctionRef<bool(mtp::Handle)> visit) override;
    Status all(FunctionRef<bool(mtp::Handle)> visit) override;
    Result<mtp::Object> find(mtp::Handle handle) override;
    Status read(mtp::Handle handle, std::uint64_t offset, std::span<std::byte> into, std::size_t& got) override;
    Status refresh(FunctionRef<void(const Change&)> changed) override;
    Status snapshots(std::int64_t first, FunctionRef<bool(const mtp::SnapshotNote&)> visit) override;
    Status mark_pulled(std::span<const mtp::PulledNote> pulled) override;
    Status offer_time(const mtp::TimeOffer& offer) override;

    /// What is there but not shown.
    const SnapshotShelf::Hidden& hidden() const noexcept { return shelf_.hidden(); }

private:
    ShelfObjects(const ShelfSettings& settings, std::unique_ptr<Medium> medium, MemoryBlock index, MemoryBlock office);

    ShelfSettings settings_;
    StoreRules rules_;
    std::unique_ptr<Medium> medium_;
    MemoryBlock index_, office_;
    SnapshotShelf shelf_;
};

} // namespace dicot::app
