// malloc behind the gate: the system's until the heap is sealed for good, then the libraries' arena.
#include "dicot/os/heap_gate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <malloc.h>

namespace dicot {
namespace {

/// Outlives every case, as the gate demands.
alignas(64) constinit std::array<std::byte, std::size_t{1} << 20> arena{};

bool in_arena(const void* block)
{
    const auto* const byte = static_cast<const std::byte*>(block);
    return byte >= arena.data() && byte < arena.data() + arena.size();
}

/// Hidden from the compiler, which knows what malloc does and may leave it out.
void* (*volatile take)(std::size_t) = [](std::size_t bytes) { return std::malloc(bytes); };
void* (*volatile take_zeroed)(std::size_t, std::size_t) = [](std::size_t n, std::size_t b) {
    return std::calloc(n, b);
};
void* (*volatile take_other)(void*, std::size_t) = [](void* block, std::size_t b) { return std::realloc(block, b); };
void (*volatile give_back)(void*) = [](void* block) { std::free(block); };
volatile std::size_t impossible = SIZE_MAX / 2;

class MallocGate : public testing::Test
{
protected:
    void SetUp() override
    {
        if (!heap_gate::replaces_operator_new())
            GTEST_SKIP() << "a sanitizer brings its own malloc";
    }
    void TearDown() override { heap_gate::reopen(); }

    static void seal() { heap_gate::seal_for_good(arena, heap_gate::Breach::kCount); }
};

TEST_F(MallocGate, ServesFromTheArenaBetweenTheSealAndItsEndAlone)
{
    void* const before = take(100);
    seal();
    void* const sealed = take(100);
    heap_gate::reopen();
    void* const after = take(100);
    EXPECT_FALSE(in_arena(before));
    EXPECT_TRUE(in_arena(sealed));
    EXPECT_FALSE(in_arena(after));
    give_back(sealed);
    EXPECT_EQ(heap_gate::libraries_heap().used_bytes, 0U) << "a block of the arena may be freed later";
    give_back(before);
    give_back(after);
}

TEST_F(MallocGate, EveryFormIsServedFromTheArenaAlignedAndComesBack)
{
    seal();
    std::array<void*, 9> blocks{};
    blocks[0] = take(100);
    blocks[1] = take_zeroed(10, 10);
    blocks[2] = take_other(nullptr, 100);
    const int aligned = ::posix_memalign(&blocks[3], 256, 100);
    blocks[4] = std::aligned_alloc(64, 128);
    blocks[5] = ::memalign(4096, 100);
    blocks[6] = ::valloc(100);
    blocks[7] = ::pvalloc(100);
    blocks[8] = take(0);
    std::array<std::size_t, 9> usable{};
    for (std::size_t i = 0; i < blocks.size(); ++i)
        usable[i] = ::malloc_usable_size(blocks[i]);
    const auto told = heap_gate::libraries_heap();
    for (void* const block : blocks)
        give_back(block);
    const std::size_t left = heap_gate::libraries_heap().used_bytes;
    heap_gate::reopen();

    const std::array<std::size_t, 9> alignments{16, 16, 16, 256, 64, 4096, 4096, 4096, 16};
    EXPECT_EQ(aligned, 0);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        EXPECT_TRUE(in_arena(blocks[i])) << i;
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(blocks[i]) % alignments[i], 0U) << i;
        EXPECT_GE(usable[i], i == 8 ? 0U : 100U) << i;
    }
    EXPECT_EQ(std::set<void*>(blocks.begin(), blocks.end()).size(), blocks.size());
    EXPECT_EQ(told.served, blocks.size());
    EXPECT_EQ(told.refused, 0U);
    EXPECT_EQ(left, 0U);
}

TEST_F(MallocGate, WhatTheCLibraryTakesItselfIsServedToo)
{
    seal();
    char* const copy = ::strdup("a library's word");
    char* text = nullptr;
    std::size_t size = 0;
    std::FILE* const stream = ::open_memstream(&text, &size);
    const bool opened = stream != nullptr && in_arena(stream);
    if (stream != nullptr) {
        (void)std::fputs("written", stream);
        (void)std::fclose(stream);
    }
    const bool both = in_arena(copy) && in_arena(text);
    const std::string said = text == nullptr ? "" : std::string(text, 7);
    ::free(copy);
    ::free(text);
    const std::size_t left = heap_gate::libraries_heap().used_bytes;
    heap_gate::reopen();
    EXPECT_TRUE(opened);
    EXPECT_TRUE(both);
    EXPECT_EQ(said, "written");
    EXPECT_EQ(left, 0U);
}

TEST_F(MallocGate, BlocksMayBeFreedAndReallocatedAcrossTheSealAndItsEnd)
{
    auto* const freed = static_cast<char*>(take(100'000));
    auto* grown = static_cast<char*>(take(3000));
    std::memset(grown, 'g', 3000);
    seal();
    give_back(freed);
    grown = static_cast<char*>(take_other(grown, 6000));
    const bool moved = in_arena(grown);
    std::memset(grown + 3000, 'h', 3000);
    heap_gate::reopen();
    grown = static_cast<char*>(take_other(grown, 9000));
    EXPECT_TRUE(moved);
    EXPECT_FALSE(in_arena(grown));
    EXPECT_EQ(std::count(grown, grown + 3000, 'g'), 3000);
    EXPECT_EQ(std::count(grown + 3000, grown + 6000, 'h'), 3000);
    EXPECT_EQ(heap_gate::libraries_heap().used_bytes, 0U);
    give_back(grown);
}

TEST_F(MallocGate, AFullArenaRefusesAndGoesOnServingWhatFits)
{
    seal();
    auto* const kept = static_cast<char*>(take(arena.size() - 4096));
    std::memset(kept, 'k', 1000);
    errno = 0;
    void* const refused = take(8192);
    const int why = errno;
    void* const never = take(impossible);
    void* const not_grown = take_other(kept, arena.size());
    void* const zeroed = take_zeroed(impossible, 16);
    void* aligned = nullptr;
    const int code = ::posix_memalign(&aligned, 64, impossible);
    void* const small = take(1000);
    const auto told = heap_gate::libraries_heap();
    heap_gate::reopen();
    EXPECT_EQ(refused, nullptr);
    EXPECT_EQ(why, ENOMEM);
    EXPECT_EQ(never, nullptr);
    EXPECT_EQ(not_grown, nullptr);
    EXPECT_EQ(std::count(kept, kept + 1000, 'k'), 1000) << "realloc that fails leaves what was there";
    EXPECT_EQ(zeroed, nullptr);
    EXPECT_EQ(code, ENOMEM);
    EXPECT_TRUE(in_arena(small));
    EXPECT_EQ(told.refused, 4U) << "of which one never came to the arena: its size overflows";
    give_back(kept);
    give_back(small);
}

TEST_F(MallocGate, CallocGivesZerosOutOfUsedMemory)
{
    seal();
    void* const dirty = take(5000);
    std::memset(dirty, 0xA5, 5000);
    give_back(dirty);
    auto* const clean = static_cast<unsigned char*>(take_zeroed(50, 100));
    const bool same_place = clean == dirty;
    const auto zeros = std::count(clean, clean + 5000, 0);
    give_back(clean);
    heap_gate::reopen();
    EXPECT_TRUE(same_place) << "the case is not what it is meant to be";
    EXPECT_EQ(zeros, 5000);
}

TEST_F(MallocGate, SealAndUnsealOfAPartChangeNothingOfASealForGood)
{
    seal();
    ::operator delete(::operator new(10));
    heap_gate::seal();
    heap_gate::unseal();
    ::operator delete(::operator new(10));
    const std::uint64_t breaches = heap_gate::breaches();
    const bool still = heap_gate::sealed();
    heap_gate::reopen();
    EXPECT_EQ(breaches, 2U);
    EXPECT_TRUE(still);
    EXPECT_FALSE(heap_gate::sealed());
}

TEST_F(MallocGate, SealedForGoodOperatorNewEndsTheProgram)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            heap_gate::seal_for_good(arena);
            heap_gate::unseal();
            ::operator delete(::operator new(4321));
        },
        testing::KilledBySignal(SIGABRT), "heap after it was sealed.*4321");
}

TEST_F(MallocGate, ThreadsThatAskAtOnceNeverShareABlock)
{
    std::array<int, 4> spoiled{};
    // Without the heap in the threads: operator new would be a breach.
    const auto work = [&spoiled](std::size_t self) {
        std::mt19937 random{static_cast<unsigned>(self + 1)};
        std::array<unsigned char*, 32> blocks{};
        std::array<std::size_t, 32> sizes{};
        const auto mark = static_cast<unsigned char>(self + 1);
        for (int step = 0; step < 20'000; ++step) {
            const std::size_t i = random() % blocks.size();
            for (std::size_t k = 0; k < sizes[i]; ++k)
                spoiled[self] += blocks[i][k] == mark ? 0 : 1;
            const std::size_t size = random() % 700;
            auto* const other = static_cast<unsigned char*>(take_other(blocks[i], size));
            if (size == 0) {
                blocks[i] = other;
                sizes[i] = 0;
            } else if (other != nullptr) {
                blocks[i] = other;
                sizes[i] = size;
                std::memset(other, mark, size);
            }
        }
        for (unsigned char* const block : blocks)
            give_back(block);
    };
    std::vector<std::thread> threads;
    threads.reserve(4);
    seal();
    const std::size_t before = heap_gate::libraries_heap().used_bytes;
    for (std::size_t self = 0; self < 4; ++self)
        threads.emplace_back(work, self);
    for (std::thread& thread : threads)
        thread.join();
    const auto told = heap_gate::libraries_heap();
    heap_gate::reopen();
    EXPECT_EQ(spoiled, (std::array<int, 4>{}));
    EXPECT_GT(told.served, 40'000U);
    EXPECT_EQ(told.refused, 0U);
    EXPECT_LE(told.used_bytes, before + 64 * 1024) << "more than what the C library keeps of ended threads";
}

} // namespace
} // namespace dicot
