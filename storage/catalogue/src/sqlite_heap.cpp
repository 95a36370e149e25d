#include "sqlite_heap.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/os/block_heap.h"
#include "dicot/os/memory_block.h"

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <mutex>

namespace dicot::sqlite_heap {
namespace {

/// SQLite asks how large a block is, which a BlockHeap does not tell: the size stands in front of it.
constexpr std::size_t kPrefixBytes = 8; // SQLite wants blocks aligned to 8

struct Heap
{
    explicit Heap(MemoryBlock given) : block(std::move(given)), heap(block.bytes()) {}
    MemoryBlock block;
    BlockHeap heap;
    std::mutex mutex; ///< SQLite's own one is switched off with its statistics
};

Heap* heap_of_sqlite = nullptr; // never let go: connections may outlive main()

std::size_t size_of(void* payload)
{
    std::size_t bytes = 0;
    std::memcpy(&bytes, static_cast<std::byte*>(payload) - kPrefixBytes, sizeof bytes);
    return bytes;
}

void* take(int bytes)
{
    const auto size = static_cast<std::size_t>(bytes);
    const std::lock_guard lock{heap_of_sqlite->mutex};
    auto* const block = static_cast<std::byte*>(heap_of_sqlite->heap.allocate(size + kPrefixBytes));
    if (block == nullptr)
        return nullptr;
    std::memcpy(block, &size, sizeof size);
    return block + kPrefixBytes;
}

void give_back(void* payload)
{
    const std::lock_guard lock{heap_of_sqlite->mutex};
    heap_of_sqlite->heap.release(static_cast<std::byte*>(payload) - kPrefixBytes);
}

void* take_other_size(void* payload, int bytes)
{
    void* const other = take(bytes);
    if (other == nullptr)
        return nullptr; // what was there stays
    std::memcpy(other, payload, std::min(size_of(payload), static_cast<std::size_t>(bytes)));
    give_back(payload);
    return other;
}

int size_in_int(void* payload)
{
    return static_cast<int>(size_of(payload));
}

int rounded_up(int bytes)
{
    return (bytes + 7) & ~7;
}

int begin(void*)
{
    return SQLITE_OK;
}

void end(void*) {}

Status start_once()
{
    Result<MemoryBlock> block = MemoryBlock::map(Catalogue::kHeapBytes);
    if (!block.ok())
        return block.status();
    static Heap heap{std::move(block).value()};
    heap_of_sqlite = &heap;
    static const sqlite3_mem_methods methods{take,  give_back, take_other_size, size_in_int, rounded_up,
                                             begin, end,       nullptr};
    const bool configured = sqlite3_config(SQLITE_CONFIG_MALLOC, &methods) == SQLITE_OK &&
                            sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0) == SQLITE_OK &&
                            sqlite3_config(SQLITE_CONFIG_LOOKASIDE, 0, 0) == SQLITE_OK &&
                            sqlite3_config(SQLITE_CONFIG_URI, 0) == SQLITE_OK;
    if (!configured || sqlite3_initialize() != SQLITE_OK)
        return failure(Fault::kSoftware, "SQLite was started before its memory was given to it");
    return {};
}

} // namespace

Status start()
{
    static const Status status = start_once();
    return status;
}

std::size_t peak_bytes()
{
    if (heap_of_sqlite == nullptr)
        return 0;
    const std::lock_guard lock{heap_of_sqlite->mutex};
    return heap_of_sqlite->heap.peak_bytes();
}

} // namespace dicot::sqlite_heap
