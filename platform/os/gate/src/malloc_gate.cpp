// malloc and its kin, in place of the C library's.
#include "libraries_heap.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>

#include <dlfcn.h>
#include <malloc.h>
#include <unistd.h>

#if DICOT_GATE_REPLACES
extern "C" {
// What glibc calls its own, for programs that replace them.
void* __libc_malloc(std::size_t bytes) noexcept;
void* __libc_calloc(std::size_t count, std::size_t bytes) noexcept;
void* __libc_realloc(void* block, std::size_t bytes) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t bytes) noexcept;
void __libc_free(void* block) noexcept;
}
#endif

namespace dicot::heap_gate {
namespace {

/// Fixed, because the first malloc of a program comes before every constructor.
struct Arena
{
    std::mutex mutex;
    std::atomic<bool> shut{false};
    std::atomic<std::uintptr_t> begin{0};
    std::atomic<std::uintptr_t> end{0};
    std::uint64_t served = 0;
    std::uint64_t refused = 0;
    alignas(BlockHeap) std::byte room[sizeof(BlockHeap)]{};
    BlockHeap* heap = nullptr;
};

constinit Arena arena;

} // namespace

void shut_malloc(std::span<std::byte> memory) noexcept
{
    const std::lock_guard lock(arena.mutex);
    const auto begin = reinterpret_cast<std::uintptr_t>(memory.data());
    arena.heap = ::new (static_cast<void*>(arena.room)) BlockHeap(memory);
    arena.begin.store(begin, std::memory_order_relaxed);
    arena.end.store(begin + memory.size(), std::memory_order_relaxed);
    arena.served = arena.refused = 0;
    arena.shut.store(DICOT_GATE_REPLACES != 0, std::memory_order_seq_cst);
}

void open_malloc() noexcept
{
    arena.shut.store(false, std::memory_order_seq_cst);
}

LibrariesHeap libraries_heap() noexcept
{
    const std::lock_guard lock(arena.mutex);
    LibrariesHeap told{arena.served, arena.refused, 0, 0};
    if (arena.heap != nullptr) {
        told.used_bytes = arena.heap->used_bytes();
        told.peak_bytes = arena.heap->peak_bytes();
    }
    return told;
}

#if DICOT_GATE_REPLACES

namespace {

bool is_shut() noexcept
{
    return arena.shut.load(std::memory_order_acquire);
}

bool holds(const void* block) noexcept
{
    const auto address = reinterpret_cast<std::uintptr_t>(block);
    return address >= arena.begin.load(std::memory_order_relaxed) &&
           address < arena.end.load(std::memory_order_relaxed);
}

void* serve(std::size_t bytes, std::size_t alignment) noexcept
{
    const std::lock_guard lock(arena.mutex);
    void* const block = arena.heap->allocate(bytes, alignment);
    ++(block != nullptr ? arena.served : arena.refused);
    if (block == nullptr)
        errno = ENOMEM;
    return block;
}

void take_back(void* block) noexcept
{
    const std::lock_guard lock(arena.mutex);
    arena.heap->release(block);
}

/// Of a block that the C library gave: only it knows.
std::size_t size_of_systems(void* block) noexcept
{
    using Ask = std::size_t (*)(void*);
    static constinit std::atomic<Ask> ask{nullptr};
    Ask known = ask.load(std::memory_order_relaxed);
    if (known == nullptr) {
        known = reinterpret_cast<Ask>(::dlsym(RTLD_NEXT, "malloc_usable_size"));
        ask.store(known, std::memory_order_relaxed);
    }
    return known == nullptr ? 0 : known(block);
}

std::size_t size_of(void* block) noexcept
{
    if (!holds(block))
        return size_of_systems(block);
    const std::lock_guard lock(arena.mutex);
    return arena.heap->size_of(block);
}

void* aligned(std::size_t alignment, std::size_t bytes) noexcept
{
    return is_shut() ? serve(bytes, alignment) : __libc_memalign(alignment, bytes);
}

std::size_t page_bytes() noexcept
{
    return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

} // namespace

#endif

} // namespace dicot::heap_gate

#if DICOT_GATE_REPLACES

// Seen by the shared libraries, however the rest of the program is compiled.
#define DICOT_EXPORTED extern "C" __attribute__((visibility("default"), used))

namespace gate = dicot::heap_gate;

DICOT_EXPORTED void* malloc(std::size_t bytes) noexcept
{
    return gate::is_shut() ? gate::serve(bytes, dicot::BlockHeap::kAlignment) : __libc_malloc(bytes);
}

DICOT_EXPORTED void free(void* block) noexcept
{
    if (gate::holds(block))
        gate::take_back(block);
    else
        __libc_free(block);
}

DICOT_EXPORTED void* calloc(std::size_t count, std::size_t bytes) noexcept
{
    if (!gate::is_shut())
        return __libc_calloc(count, bytes);
    std::size_t all = 0;
    if (__builtin_mul_overflow(count, bytes, &all)) {
        errno = ENOMEM;
        return nullptr;
    }
    void* const block = gate::serve(all, dicot::BlockHeap::kAlignment);
    return block == nullptr ? nullptr : std::memset(block, 0, all);
}

DICOT_EXPORTED void* realloc(void* block, std::size_t bytes) noexcept
{
    if (!gate::is_shut() && !gate::holds(block))
        return __libc_realloc(block, bytes);
    if (block == nullptr)
        return malloc(bytes);
    if (bytes == 0) {
        free(block);
        return nullptr;
    }
    const std::size_t size = gate::size_of(block);
    if (gate::holds(block) && bytes <= size && bytes >= size / 2)
        return block;
    void* const other = malloc(bytes);
    if (other == nullptr)
        return nullptr; // what was there stays
    std::memcpy(other, block, std::min(size, bytes));
    free(block);
    return other;
}

DICOT_EXPORTED void* memalign(std::size_t alignment, std::size_t bytes) noexcept
{
    return gate::aligned(std::bit_ceil(std::max(alignment, dicot::BlockHeap::kAlignment)), bytes);
}

DICOT_EXPORTED void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept
{
    return memalign(alignment, bytes);
}

DICOT_EXPORTED int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) noexcept
{
    if (!std::has_single_bit(alignment) || alignment % sizeof(void*) != 0)
        return EINVAL;
    const int before = errno;
    void* const served = memalign(alignment, bytes);
    errno = before;
    if (served == nullptr)
        return ENOMEM;
    *block = served;
    return 0;
}

DICOT_EXPORTED void* valloc(std::size_t bytes) noexcept
{
    return memalign(gate::page_bytes(), bytes);
}

DICOT_EXPORTED void* pvalloc(std::size_t bytes) noexcept
{
    const std::size_t page = gate::page_bytes();
    if (bytes > SIZE_MAX - page) {
        errno = ENOMEM;
        return nullptr;
    }
    return memalign(page, (bytes + page - 1) / page * page);
}

DICOT_EXPORTED std::size_t malloc_usable_size(void* block) noexcept
{
    return block == nullptr ? 0 : gate::size_of(block);
}

#endif
