#include "dicot/os/memory_reserve.h"

#include <atomic>
#include <cstring>

namespace dicot {
namespace {

constinit std::atomic<MemoryReserve*> serving{nullptr};

} // namespace

MemoryReserve::MemoryReserve(std::span<std::byte> memory) noexcept : heap_(memory)
{
    MemoryReserve* none = nullptr;
    serving.compare_exchange_strong(none, this);
}

MemoryReserve::~MemoryReserve()
{
    MemoryReserve* self = this;
    serving.compare_exchange_strong(self, nullptr);
}

MemoryReserve* MemoryReserve::in_use() noexcept
{
    return serving.load();
}

std::span<std::byte> MemoryReserve::take(std::size_t bytes) noexcept
{
    void* block = nullptr;
    {
        const std::lock_guard lock(mutex_);
        block = heap_.allocate(bytes, kPageBytes);
        refused_ += block == nullptr ? 1 : 0;
    }
    if (block == nullptr)
        return {};
    return {static_cast<std::byte*>(std::memset(block, 0, bytes)), bytes};
}

void MemoryReserve::take_back(std::span<std::byte> block) noexcept
{
    const std::lock_guard lock(mutex_);
    heap_.release(block.data());
}

std::size_t MemoryReserve::used_bytes() const noexcept
{
    const std::lock_guard lock(mutex_);
    return heap_.used_bytes();
}

std::size_t MemoryReserve::peak_bytes() const noexcept
{
    const std::lock_guard lock(mutex_);
    return heap_.peak_bytes();
}

std::uint64_t MemoryReserve::refused() const noexcept
{
    const std::lock_guard lock(mutex_);
    return refused_;
}

} // namespace dicot
