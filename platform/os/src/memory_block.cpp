#include "dicot/os/memory_block.h"

#include "dicot/os/memory_reserve.h"

#include <utility>

#include <sys/mman.h>

namespace dicot {
namespace {

constexpr std::size_t kMiB = std::size_t{1024} * 1024;

} // namespace

MemoryBlock::MemoryBlock(MemoryBlock&& other) noexcept
    : bytes_(std::exchange(other.bytes_, {})), reserve_(std::exchange(other.reserve_, nullptr))
{
}

MemoryBlock& MemoryBlock::operator=(MemoryBlock&& other) noexcept
{
    std::swap(bytes_, other.bytes_);
    std::swap(reserve_, other.reserve_);
    return *this;
}

MemoryBlock::~MemoryBlock()
{
    if (reserve_ != nullptr)
        reserve_->take_back(bytes_);
    else if (!bytes_.empty())
        ::munmap(bytes_.data(), bytes_.size());
}

Result<MemoryBlock> MemoryBlock::map(std::size_t bytes, Pages pages) noexcept
{
    MemoryBlock block;
    if (bytes == 0)
        return block;
    if (MemoryReserve* const reserve = MemoryReserve::in_use(); reserve != nullptr) {
        block.bytes_ = reserve->take(bytes);
        if (block.bytes_.empty())
            return failure(Fault::kOsError,
                           "the memory that was set apart at the start has no room for a block of %zu KiB: it was "
                           "measured for other pictures; start again",
                           (bytes + 1023) / 1024);
        block.reserve_ = reserve;
        return block;
    }
    const int populate = pages == Pages::kResident ? MAP_POPULATE : 0;
    void* const start = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | populate, -1, 0);
    if (start == MAP_FAILED)
        return failure(Fault::kOsError,
                       "the system refuses %zu MiB of memory; use smaller pictures or fewer disparities, or end other "
                       "programs",
                       bytes / kMiB + (bytes % kMiB != 0 ? 1 : 0));
    block.bytes_ = {static_cast<std::byte*>(start), bytes};
    return block;
}

} // namespace dicot
