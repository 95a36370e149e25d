// The store of this board as the objects that a host sees.
#pragma once

#include "clock_offer.h"

#include "dicot/mtp/object_source.h"
#include "dicot/os/memory_block.h"
#include "dicot/shelf/snapshot_shelf.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace dicot::app {

/// What ShelfObjects takes, all of it in open(), but for `pages`.
struct ShelfBudget
{
    std::size_t index = 0;     ///< 16 bytes a snapshot; resident as it fills
    std::size_t office = 0;    ///< for operator new while marks are written
    std::size_t catalogue = 0; ///< SQLite's block, mapped
    std::size_t catalogue_resident = 0;
    std::size_t pages = 0; ///< of MemoryBlock::map() while marks are written: for the process's MemoryReserve

    std::size_t mapped() const { return index + office + catalogue + pages; }
    std::size_t resident() const { return index + office + catalogue_resident + pages; }
};
ShelfBudget shelf_budget(const SnapshotShelf::Limits& limits = {}) noexcept;

/// What of the store is not shown and why, a sentence for the log; empty: everything is.
ShortText<255> hidden_words(const SnapshotShelf::Hidden& hidden);

struct ShelfSettings
{
    std::string path;                   ///< folder of the board's snapshots
    std::string device;                 ///< the board's name: the folder at the top
    StoreRules rules;                   ///< of output
    bool marks = true;                  ///< usb.marks
    std::string clock_rule = "not set"; ///< usb.clock
    SnapshotShelf::Limits limits{};
    std::string offer_file = kClockOfferFile;
    std::int64_t clock_patience_us = 5'000'000; ///< for who sets the clock in our place
};

/// Handles are computed, and so mean the same for ever: 1 the board's folder; 0x80000000 + days since 1970 a day;
/// 16 x number + member what belongs to a snapshot: member 0 its folder, 1 .. 8 the files in the order of SHA256SUMS,
/// 15 SHA256SUMS.
class ShelfObjects final : public mtp::ObjectSource
{
public:
    /// Before the heap is sealed: afterwards nothing is taken but `pages`. Reads all names. Fault::kNoInput: there is
    /// no such folder; kOsError: no memory; kIoError.
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

    /// What is there and not shown.
    const SnapshotShelf::Hidden& hidden() const noexcept { return shelf_.hidden(); }

private:
    ShelfObjects(const ShelfSettings& settings, std::unique_ptr<Medium> medium, MemoryBlock index, MemoryBlock office);

    ShelfSettings settings_;
    std::unique_ptr<Medium> medium_;
    MemoryBlock index_, office_;
    SnapshotShelf shelf_;
};

} // namespace dicot::app
