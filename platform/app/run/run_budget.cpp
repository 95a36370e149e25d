#include "run_budget.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/os/memory_reserve.h"
#include "dicot/os/process_memory.h"
#include "dicot/os/thread_crew.h"
#include "dicot/record/record.h"

#include <cstdint>

namespace dicot::app {
namespace {

constexpr std::size_t kKiB = 1024;
constexpr std::size_t kMiB = 1024 * kKiB;

/// Pages of code that the bare program has not touched yet (SQLite's, libjpeg's), what the system's heap served before
/// the seal, the stacks: 2.2 MiB seen.
constexpr std::size_t kWorkingBytes = 2560 * kKiB;
/// The system's heap grows by pieces.
constexpr std::size_t kHeapGrowthBytes = 2 * kMiB;
/// Beside the crew: libusb's events and its monitor, and who looks after the gadget's process.
constexpr int kOtherThreads = 3;
constexpr std::size_t kGuardBytes = 64 * kKiB; ///< below a stack: a page, of 64 KiB at most

/// Of a catalogue that is written to, without the sorting of large tables; half a MiB seen over 10,000 snapshots.
constexpr std::size_t kCatalogueResidentBytes = kMiB;
constexpr std::size_t kRecordBytes = kRecordHeapBytes + kMaxRecordBytes + 64 * kKiB;

constexpr std::size_t kOfficeBytes = 512 * kKiB; // recorded pictures: 52 KiB seen over 10,000 slots
constexpr std::size_t kLibrariesBytes = kMiB;    // 0.3 MiB seen: a PNG's compressor

RunBudget::Part with(RunBudget::Part part, std::size_t resident, std::size_t mapped)
{
    part.resident = resident;
    part.mapped = mapped;
    return part;
}

} // namespace

Result<BareProcess> BareProcess::measure()
{
    const ProcessMemory now = TRY(process_memory());
    return BareProcess{static_cast<std::size_t>(now.resident_bytes), static_cast<std::size_t>(now.address_bytes)};
}

std::size_t RunBudget::resident() const
{
    std::size_t sum = 0;
    for (const Part& part : parts())
        sum += part.resident;
    return sum;
}

std::size_t RunBudget::mapped() const
{
    std::size_t sum = 0;
    for (const Part& part : parts())
        sum += part.mapped;
    return sum;
}

Result<RunBudget> run_budget(const Config& config, const BareProcess& bare, const CameraMemory& cameras,
                             const ProcessBudget& clouds, int threads)
{
    RunBudget budget;
    const auto stacks = static_cast<std::size_t>(threads - 1 + kOtherThreads) * (ThreadCrew::kStackBytes + kGuardBytes);
    budget.program =
        with(budget.program, bare.resident_bytes + kWorkingBytes, bare.address_bytes + kHeapGrowthBytes + stacks);
    budget.clouds = with(budget.clouds, clouds.total(), clouds.total() + 2 * kGuardBytes);
    const std::size_t desk = MemoryReserve::bytes_for(kRecordBytes);
    budget.store =
        with(budget.store, kCatalogueResidentBytes + desk, Catalogue::kHeapBytes + 2 * desk); // one before the seal
    budget.cameras = with(budget.cameras, cameras.frames, cameras.frames + cameras.kernels);
    budget.pages = cameras.frames + desk;
    const std::size_t office = kOfficeBytes + cameras.office;
    budget.office = with(budget.office, office, office);
    const std::size_t libraries = kLibrariesBytes + cameras.libraries;
    budget.libraries = with(budget.libraries, libraries, libraries);
    const std::uint64_t most = static_cast<std::uint64_t>(config.run.most_memory_mib) * kMiB;
    if (most != 0 && budget.resident() > most)
        return failure(Fault::kConfig,
                       "dicot run would take %.1f MiB of memory with these pictures, %d threads and these cameras, and "
                       "run.most_memory_mib allows %d: use smaller pictures, a rig.near_mm that is further "
                       "away, fewer matching.threads, or allow more",
                       static_cast<double>(budget.resident()) / kMiB, threads, config.run.most_memory_mib);
    return budget;
}

} // namespace dicot::app
