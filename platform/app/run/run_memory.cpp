#include "run_memory.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <exception>
#include <new>

#include <linux/capability.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace dicot::app {
namespace {

constexpr std::size_t kStackBytes = std::size_t{256} * 1024;

/// CAP_IPC_LOCK: whoever has it is asked for no limit.
bool may_lock_all() noexcept
{
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3]{};
    return ::syscall(SYS_capget, &header, data) == 0 && (data[0].effective & (1U << CAP_IPC_LOCK)) != 0;
}

/// It stays mapped to the end of the process: what was served from it may be looked at until then.
void leave_mapped(MemoryBlock& block) noexcept
{
    ::new (static_cast<void*>(&block)) MemoryBlock;
}

} // namespace

void RunMemory::keep_address_space_known() noexcept
{
    (void)::mallopt(M_ARENA_MAX, 1);
    pthread_attr_t attributes;
    if (::pthread_attr_init(&attributes) != 0)
        return;
    const auto least = static_cast<std::size_t>(PTHREAD_STACK_MIN);
    if (::pthread_attr_setstacksize(&attributes, std::max(kStackBytes, least)) == 0)
        (void)::pthread_setattr_default_np(&attributes);
    (void)::pthread_attr_destroy(&attributes);
}

Result<std::unique_ptr<RunMemory>> RunMemory::carve(const RunBudget& budget)
{
    std::unique_ptr<RunMemory> memory(new RunMemory);
    memory->pages_block_ = TRY(MemoryBlock::map(budget.pages));
    memory->office_block_ = TRY(MemoryBlock::map(budget.office.mapped));
    memory->libraries_block_ = TRY(MemoryBlock::map(budget.libraries.mapped));
    return memory;
}

RunMemory::~RunMemory()
{
    if (!office_)
        return;
    heap_gate::reopen();
    office_.reset();
    pages_.reset();
    leave_mapped(office_block_);
    leave_mapped(libraries_block_);
}

Status RunMemory::lock_in_ram(const RunBudget& budget) noexcept
{
    // A limit that is met later would refuse the cameras their buffers: rather no lock than half a one.
    rlimit limit{};
    if (!may_lock_all() && (::getrlimit(RLIMIT_MEMLOCK, &limit) != 0 || limit.rlim_cur < budget.mapped()))
        return failure(Fault::kOsError,
                       "memory is not locked in RAM: this user may lock %zu KiB and %zu are needed; set "
                       "LimitMEMLOCK=infinity in the unit",
                       static_cast<std::size_t>(limit.rlim_cur / 1024), budget.mapped() / 1024);
    if (::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0)
        return failure(Fault::kOsError, "memory is not locked in RAM (%s)", strerrordesc_np(errno));
    return {};
}

void RunMemory::seal(heap_gate::Breach breach)
{
    pages_.emplace(pages_block_.bytes());
    office_.emplace(office_block_.bytes());
    heap_gate::seal_for_good(libraries_block_.bytes(), breach);
}

Status RunMemory::safely(FunctionRef<Status()> work) noexcept
{
    try {
        return work();
    } catch (const std::bad_alloc&) {
        ++office_refused_;
        return failure(Fault::kOsError,
                       "the %zu KiB that are set apart for records and cameras do not suffice: use fewer recorded "
                       "pictures, or report it",
                       office_block_.bytes().size() / 1024);
    } catch (const std::exception& other) {
        return failure(Fault::kSoftware, "a fault of dicot: %s", other.what());
    }
}

RunMemoryFigures RunMemory::figures() const noexcept
{
    RunMemoryFigures told;
    const heap_gate::LibrariesHeap libraries = heap_gate::libraries_heap();
    told.breaches = heap_gate::breaches();
    told.office_refused = office_refused_;
    told.library_refused = libraries.refused;
    told.libraries_served = libraries.served;
    told.libraries_used_bytes = libraries.used_bytes;
    told.libraries_peak_bytes = libraries.peak_bytes;
    if (pages_) {
        told.pages_refused = pages_->refused();
        told.pages_used_bytes = pages_->used_bytes();
        told.pages_peak_bytes = pages_->peak_bytes();
    }
    if (office_) {
        told.office_used_bytes = office_->used_bytes();
        told.office_peak_bytes = office_->peak_bytes();
    }
    return told;
}

} // namespace dicot::app
