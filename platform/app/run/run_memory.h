// The memory of `dicot run`: carved once, sealed, the same for months.
#pragma once

#include "run_budget.h"

#include "dicot/base/function_ref.h"
#include "dicot/base/status.h"
#include "dicot/os/heap_gate.h"
#include "dicot/os/memory_block.h"
#include "dicot/os/memory_reserve.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace dicot::app {

/// What happened in memory since the seal. The first four are 0 as long as the promise holds.
struct RunMemoryFigures
{
    std::uint64_t breaches = 0;         ///< operator new of a thread that was lent nothing
    std::uint64_t office_refused = 0;   ///< works that were ended because the office was full
    std::uint64_t library_refused = 0;  ///< times that malloc found its arena full
    std::uint64_t pages_refused = 0;    ///< blocks of pages that did not fit
    std::uint64_t libraries_served = 0; ///< times that malloc served
    std::size_t office_used_bytes = 0;  ///< now; between slots the same, or something stays behind at every slot
    std::size_t libraries_used_bytes = 0;
    std::size_t pages_used_bytes = 0;
    std::size_t office_peak_bytes = 0;
    std::size_t libraries_peak_bytes = 0;
    std::size_t pages_peak_bytes = 0;
};

/// In this order: keep_address_space_known(), BareProcess::measure(); tables and threads; run_budget(), carve(),
/// lock_in_ram(); the store opened once, for what SQLite takes at its start; seal(); then slots one after the other,
/// each in safely(). All in one thread.
class RunMemory
{
public:
    /// Before the first thread: the C library's heap grows in one place, and threads whose stacks nobody sized
    /// (libusb's monitor) get 256 KiB instead of 8 MiB.
    static void keep_address_space_known() noexcept;

    /// Maps office, libraries' arena and reserve of pages. Fault::kOsError: the system has not that much.
    static Result<std::unique_ptr<RunMemory>> carve(const RunBudget& budget);
    RunMemory(const RunMemory&) = delete;
    RunMemory& operator=(const RunMemory&) = delete;
    /// Opens the heap again. What the office served may be looked at to the end of the process.
    ~RunMemory();

    /// Everything stays in RAM from now on, pages as they are touched. Fault::kOsError: the system does not let this
    /// user; the sentence says how it would.
    static Status lock_in_ram(const RunBudget& budget) noexcept;

    /// Closes the heap. From here to the end of this object operator
    /// new of this thread is served from the office, malloc from the libraries' arena and MemoryBlock::map() from the
    /// reserve.
    void seal(heap_gate::Breach breach = heap_gate::Breach::kStop);

    /// `work`, and a full office as Fault::kOsError instead of an exception; any other exception as Fault::kSoftware.
    Status safely(FunctionRef<Status()> work) noexcept;

    RunMemoryFigures figures() const noexcept;

private:
    RunMemory() = default;

    MemoryBlock office_block_, libraries_block_, pages_block_;
    std::optional<MemoryReserve> pages_;
    std::optional<LentHeap> office_;
    std::uint64_t office_refused_ = 0;
};

} // namespace dicot::app
