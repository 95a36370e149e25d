// Marks of pulls, written by a process whose heap is sealed.
#pragma once

#include "dicot/base/status.h"
#include "dicot/mtp/snapshot_note.h"
#include "dicot/store/store.h"

#include <cstddef>
#include <span>
#include <string>

namespace dicot::app {

/// What `office` must hold: the store's objects, names, 512 marks at once.
inline constexpr std::size_t kMarksOfficeBytes = std::size_t{192} << 10;
/// What MemoryBlock::map() gives meanwhile.
std::size_t marks_pages_bytes() noexcept;

/// Opens the store at `path` for writing, and closes it again. operator new of this thread is served from `office`
/// meanwhile. Faults: those of Store::open() (kTryAgain: a slot is under way) and of Store::mark_pulled(); kOsError:
/// `office` is full.
Status write_marks(const std::string& path, const StoreRules& rules, std::span<const mtp::PulledNote> pulled,
                   std::span<std::byte> office) noexcept;

/// What SQLite takes at its first start it takes now.
Status start_catalogue();

} // namespace dicot::app
