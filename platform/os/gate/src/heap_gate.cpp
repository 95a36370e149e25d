#include "dicot/os/heap_gate.h"

#include "libraries_heap.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#include <unistd.h>

namespace dicot::heap_gate {
namespace {

enum class State
{
    kOpen,
    kCounting,
    kStopping
};

constinit std::atomic<State> state{State::kOpen};
constinit std::atomic<std::uint64_t> breach_count{0};
constinit std::atomic<bool> for_good{false};

void set(State to) noexcept
{
    state.store(to, std::memory_order_seq_cst);
}

void begin_counting(Breach breach) noexcept
{
    breach_count.store(0, std::memory_order_relaxed);
    set(breach == Breach::kStop ? State::kStopping : State::kCounting);
}

} // namespace

bool replaces_operator_new() noexcept
{
    return DICOT_GATE_REPLACES != 0;
}

void seal(Breach breach) noexcept
{
    if (!sealed_for_good())
        begin_counting(breach);
}

void unseal() noexcept
{
    if (!sealed_for_good())
        set(State::kOpen);
}

void seal_for_good(std::span<std::byte> libraries, Breach breach) noexcept
{
    for_good.store(true, std::memory_order_relaxed);
    shut_malloc(libraries);
    begin_counting(breach);
}

void reopen() noexcept
{
    for_good.store(false, std::memory_order_relaxed);
    open_malloc();
    set(State::kOpen);
}

bool sealed_for_good() noexcept
{
    return for_good.load(std::memory_order_relaxed);
}

bool sealed() noexcept
{
    return state.load(std::memory_order_relaxed) != State::kOpen;
}

std::uint64_t breaches() noexcept
{
    return breach_count.load(std::memory_order_relaxed);
}

#if DICOT_GATE_REPLACES

namespace {

/// Without stdio, which may itself allocate.
[[noreturn]] void stop(std::size_t bytes) noexcept
{
    char sentence[160] =
        "dicot: a fault of dicot: bytes asked of the heap after it was sealed, outside of lent memory: ";
    std::size_t length = 0;
    while (sentence[length] != '\0')
        ++length;
    std::size_t scale = 1;
    while (bytes / scale >= 10)
        scale *= 10;
    for (; scale != 0; scale /= 10)
        sentence[length++] = static_cast<char>('0' + bytes / scale % 10);
    sentence[length++] = '\n';
    (void)!::write(STDERR_FILENO, sentence, length);
    std::abort();
}

void* from_malloc(std::size_t bytes, std::size_t alignment) noexcept
{
    void* block = nullptr;
    if (alignment <= alignof(std::max_align_t))
        block = std::malloc(bytes == 0 ? 1 : bytes);
    else if (::posix_memalign(&block, alignment, bytes == 0 ? 1 : bytes) != 0)
        return nullptr;
    LentHeap::forget_ended(block);
    return block;
}

void* serve(std::size_t bytes, std::size_t alignment) noexcept
{
    if (BlockHeap* const lent = LentHeap::of_this_thread(); lent != nullptr)
        return lent->allocate(bytes, alignment);
    switch (state.load(std::memory_order_relaxed)) {
    case State::kStopping:
        stop(bytes);
    case State::kCounting:
        breach_count.fetch_add(1, std::memory_order_relaxed);
        break;
    case State::kOpen:
        break;
    }
    return from_malloc(bytes, alignment);
}

void* serve_or_throw(std::size_t bytes, std::size_t alignment)
{
    void* const block = serve(bytes, alignment);
    if (block == nullptr)
        throw std::bad_alloc();
    return block;
}

void take_back(void* block) noexcept
{
    if (block == nullptr)
        return;
    const LentHeap::Origin origin = LentHeap::origin_of(block);
    if (!origin.lent)
        std::free(block);
    else if (origin.heap != nullptr)
        origin.heap->release(block);
}

constexpr std::size_t kPlain = alignof(std::max_align_t);

} // namespace

#endif

} // namespace dicot::heap_gate

#if DICOT_GATE_REPLACES

using dicot::heap_gate::kPlain;
using dicot::heap_gate::serve;
using dicot::heap_gate::serve_or_throw;
using dicot::heap_gate::take_back;

void* operator new(std::size_t bytes)
{
    return serve_or_throw(bytes, kPlain);
}
void* operator new[](std::size_t bytes)
{
    return serve_or_throw(bytes, kPlain);
}
void* operator new(std::size_t bytes, std::align_val_t to)
{
    return serve_or_throw(bytes, static_cast<std::size_t>(to));
}
void* operator new[](std::size_t bytes, std::align_val_t to)
{
    return serve_or_throw(bytes, static_cast<std::size_t>(to));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept
{
    return serve(bytes, kPlain);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept
{
    return serve(bytes, kPlain);
}
void* operator new(std::size_t bytes, std::align_val_t to, const std::nothrow_t&) noexcept
{
    return serve(bytes, static_cast<std::size_t>(to));
}
void* operator new[](std::size_t bytes, std::align_val_t to, const std::nothrow_t&) noexcept
{
    return serve(bytes, static_cast<std::size_t>(to));
}

void operator delete(void* block) noexcept
{
    take_back(block);
}
void operator delete[](void* block) noexcept
{
    take_back(block);
}
void operator delete(void* block, std::size_t) noexcept
{
    take_back(block);
}
void operator delete[](void* block, std::size_t) noexcept
{
    take_back(block);
}
void operator delete(void* block, std::align_val_t) noexcept
{
    take_back(block);
}
void operator delete[](void* block, std::align_val_t) noexcept
{
    take_back(block);
}
void operator delete(void* block, std::size_t, std::align_val_t) noexcept
{
    take_back(block);
}
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept
{
    take_back(block);
}
void operator delete(void* block, const std::nothrow_t&) noexcept
{
    take_back(block);
}
void operator delete[](void* block, const std::nothrow_t&) noexcept
{
    take_back(block);
}
void operator delete(void* block, std::align_val_t, const std::nothrow_t&) noexcept
{
    take_back(block);
}
void operator delete[](void* block, std::align_val_t, const std::nothrow_t&) noexcept
{
    take_back(block);
}

#endif
