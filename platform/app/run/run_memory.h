// The memory of `dicot run`: carved once, sealed, the same for months.
#pragma once

#include "run_budget.h"

#include "dicot/base/function_ref.h"
#include "dicot/base/status.h"
#include "dicot/os/memory_block.h"
#include "dicot/os/memory_reserve.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace dicot::app {

/// What happened in memory since the seal. All but the peaks are 0 as long as the promise holds.
struct RunMemoryFigures
{
    std::uint64_t breaches = 0;      ///< operator new outside of every lease
    std::uint64_t library_fails = 0; ///< malloc found the libraries' arena full
    std::uint64_t frame_fails = 0;   ///< a camera's block did not fit
    std::uint64_t office_fails = 0;  ///< slots that were ended because the office was full
    std::size_t office_peak_bytes = 0;
    std::size_t libraries_peak_bytes = 0;
    std::size_t frames_peak_bytes = 0;
};

/// In this order: BareProcess::measure() and keep_address_space_known() first of all; tables, store and threads; then
/// carve(), seal(), and slots one after the other, each in in_office().
class RunMemory
{
public:
    /// Before the first thread: the C library's heap grows in one place, and threads whose stacks nobody sized
    /// (libusb's monitor) get 256 KiB instead of 8 MiB.
    static void keep_address_space_known() noexcept;

    /// Maps office, libraries' arena and frames. Fault::kOsError: the system has not that much.
    static Result<std::unique_ptr<RunMemory>> carve(const RunBudget& budget);
    RunMemory(const RunMemory&) = delete;
    RunMemory& operator=(const RunMemory&) = delete;
    /// Opens the gate; what libraries hold of their arena stays valid.
    ~RunMemory();

    /// Everything stays in RAM from now on, pages as they are touched. Fault::kOsError: the system does not let this
    /// user; the sentence says how it would.
    static Status lock_in_ram() noexcept;

    /// Uses once what libraries fill on first use, then closes the heap. Breach::kCount for tests.
    void seal(bool counts_breaches = false);

    /// One slot's work: operator new of this thread is served from the office, which is empty again afterwards, so
    /// nothing that was made inside may be used outside. A full office ends the work: Fault::kOsError.
    Status in_office(FunctionRef<Status()> work) noexcept;

    RunMemoryFigures figures() const noexcept;

private:
    RunMemory() = default;

    MemoryBlock office_, libraries_, frames_;
    std::optional<MemoryReserve> reserve_;
    bool sealed_ = false;
    std::uint64_t office_fails_ = 0;
    std::size_t office_peak_bytes_ = 0;
};

} // namespace dicot::app
