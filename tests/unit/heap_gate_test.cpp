#include "dicot/os/heap_gate.h"

#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace dicot {
namespace {

template <std::size_t kBytes>
struct Block
{
    alignas(64) std::array<std::byte, kBytes> bytes{};
    bool holds(const void* pointer) const
    {
        const auto* const byte = static_cast<const std::byte*>(pointer);
        return byte >= bytes.data() && byte < bytes.data() + kBytes;
    }
};

/// What these tests do on purpose (deleting twice, deleting what has gone) is hidden from the compiler, which knows
/// better.
void (*volatile give_back)(void*) = [](void* block) { ::operator delete(block); };
volatile std::size_t impossible = SIZE_MAX - 8;

class HeapGate : public testing::Test
{
protected:
    void SetUp() override
    {
        if (!heap_gate::replaces_operator_new())
            GTEST_SKIP() << "a sanitizer brings its own operator new";
    }
    void TearDown() override { heap_gate::unseal(); }

    Block<256 * 1024> lent_;
};

TEST(HeapGateBuild, ReplacesOperatorNewExactlyWhereNoSanitizerDoes)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    EXPECT_FALSE(heap_gate::replaces_operator_new());
#elif !defined(__clang__)
    EXPECT_TRUE(heap_gate::replaces_operator_new());
#endif
}

TEST_F(HeapGate, SealedWithoutALeaseEndsTheProgramWithASentence)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            heap_gate::seal();
            ::operator delete(::operator new(12345));
        },
        testing::KilledBySignal(SIGABRT), "heap after it was sealed.*12345");
}

TEST_F(HeapGate, ALeaseOfOneThreadDoesNotServeAnother)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            const LentHeap lent{lent_.bytes};
            std::thread other([] {
                heap_gate::seal();
                ::operator delete(::operator new(777));
            });
            other.join();
        },
        testing::KilledBySignal(SIGABRT), "sealed.*777");
}

TEST_F(HeapGate, EveryFormOfNewIsServedFromTheLeaseAndAligned)
{
    struct alignas(256) Wide
    {
        std::array<char, 300> bytes;
    };
    std::array<void*, 8> blocks{};
    std::size_t used = 0;
    std::size_t left = 0;
    {
        LentHeap lent{lent_.bytes};
        heap_gate::seal();
        blocks = {
            ::operator new(100),
            ::operator new[](100),
            ::operator new(100, std::nothrow),
            ::operator new[](100, std::nothrow),
            ::operator new (100, std::align_val_t{64}),
            ::operator new[](100, std::align_val_t{128}),
            ::operator new (100, std::align_val_t{4096}, std::nothrow),
            new Wide,
        };
        used = lent.used_bytes();
        ::operator delete(blocks[0]);
        ::operator delete[](blocks[1]);
        ::operator delete(blocks[2], std::nothrow);
        ::operator delete[](blocks[3], std::nothrow);
        ::operator delete (blocks[4], std::align_val_t{64});
        ::operator delete[](blocks[5], std::align_val_t{128});
        ::operator delete (blocks[6], std::align_val_t{4096}, std::nothrow);
        delete static_cast<Wide*>(blocks[7]);
        left = lent.used_bytes();
        heap_gate::unseal();
    }
    const std::array<std::size_t, 8> alignments{16, 16, 16, 16, 64, 128, 4096, 256};
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        EXPECT_TRUE(lent_.holds(blocks[i])) << i;
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(blocks[i]) % alignments[i], 0U) << i;
    }
    EXPECT_GE(used, 7U * 100 + 512);
    EXPECT_EQ(left, 0U);
    EXPECT_EQ(heap_gate::breaches(), 0U);
}

TEST_F(HeapGate, AGrowingVectorReusesWhatItGaveBack)
{
    std::uint64_t sum = 0;
    std::size_t left = 1;
    {
        LentHeap lent{lent_.bytes};
        heap_gate::seal();
        // 400 vectors that grow to 64 KiB are 200 times the lease.
        for (std::uint32_t round = 0; round < 400; ++round) {
            std::vector<std::uint32_t> values;
            for (std::uint32_t i = 0; i < 12'000; ++i)
                values.push_back(i ^ round);
            sum += values[round];
        }
        left = lent.used_bytes();
        heap_gate::unseal();
    }
    EXPECT_EQ(sum, 0U); // i ^ i
    EXPECT_EQ(left, 0U);
}

TEST_F(HeapGate, AFullLeaseThrowsBadAllocAndGoesOnServingWhatFits)
{
    bool thrown = false;
    void* small = nullptr;
    void* refused = &small;
    {
        LentHeap lent{lent_.bytes};
        heap_gate::seal();
        try {
            ::operator delete(::operator new(lent_.bytes.size()));
        } catch (const std::bad_alloc&) {
            thrown = true;
        }
        refused = ::operator new(impossible, std::nothrow);
        small = ::operator new(1000);
        heap_gate::unseal();
        give_back(small);
    }
    EXPECT_TRUE(thrown);
    EXPECT_EQ(refused, nullptr);
    EXPECT_TRUE(lent_.holds(small));
}

TEST_F(HeapGate, LeasesNestAndTheInnermostServes)
{
    Block<16 * 1024> inner_block;
    void* first = nullptr;
    void* second = nullptr;
    void* third = nullptr;
    std::size_t left = 1;
    {
        LentHeap outer{lent_.bytes};
        first = ::operator new(100);
        {
            const LentHeap inner{inner_block.bytes};
            second = ::operator new(100);
            give_back(first); // belongs to the outer one
        }
        third = ::operator new(100);
        give_back(third);
        left = outer.used_bytes();
    }
    EXPECT_TRUE(lent_.holds(first));
    EXPECT_TRUE(inner_block.holds(second));
    EXPECT_EQ(third, first) << "given back to the outer lease and served again";
    EXPECT_EQ(left, 0U);
}

TEST_F(HeapGate, BlocksFromBeforeTheSealMayBeDeletedAfterIt)
{
    auto before = std::make_unique<std::vector<int>>(1000, 7);
    heap_gate::seal();
    before.reset();
    heap_gate::unseal();
    EXPECT_EQ(heap_gate::breaches(), 0U);
}

TEST_F(HeapGate, DeletingLentMemoryAfterTheLeaseEndedIsHarmless)
{
    void* stale = nullptr;
    {
        const LentHeap lent{lent_.bytes};
        give_back(::operator new(100));
        void* const before = ::operator new(1000);
        stale = ::operator new(100);
        give_back(before);
    }
    give_back(stale);

    // Also when the same memory is lent again and something else lies there.
    std::array<std::size_t, 4> used{};
    {
        LentHeap again{lent_.bytes};
        void* const fresh = ::operator new(50'000);
        used[0] = again.used_bytes();
        give_back(stale);
        used[1] = again.used_bytes();
        give_back(fresh);
        used[2] = again.used_bytes();
        give_back(fresh);
        used[3] = again.used_bytes();
    }
    EXPECT_GE(used[0], 50'000U);
    EXPECT_EQ(used[1], used[0]) << "the old block's delete changed the new heap";
    EXPECT_EQ(used[2], 0U);
    EXPECT_EQ(used[3], 0U) << "deleted twice";
}

TEST_F(HeapGate, AnotherThreadMayDeleteWhatALeaseServed)
{
    void* block = nullptr;
    std::size_t left = 1;
    {
        LentHeap lent{lent_.bytes};
        block = ::operator new(5000);
        std::thread other([block] { give_back(block); }); // its own state is lent too
        other.join();
        left = lent.used_bytes();
    }
    EXPECT_TRUE(lent_.holds(block));
    EXPECT_EQ(left, 0U);
}

TEST_F(HeapGate, CountsWhatWouldHaveStoppedTheProgram)
{
    heap_gate::seal(heap_gate::Breach::kCount);
    EXPECT_TRUE(heap_gate::sealed());
    ::operator delete(::operator new(10));
    ::operator delete[](::operator new[](10));
    const std::uint64_t counted = heap_gate::breaches();
    heap_gate::unseal();
    EXPECT_EQ(counted, 2U);
    EXPECT_FALSE(heap_gate::sealed());
}

TEST(BlockHeap, RandomUseNeverOverlapsAndMeltsBackIntoOneBlock)
{
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random{seed};
        std::vector<std::byte> memory(200'000 + random() % 64);
        const auto span = std::span{memory}.subspan(random() % 32);
        BlockHeap heap{span};
        struct Piece
        {
            std::byte* start;
            std::size_t size;
            std::byte mark;
        };
        std::vector<Piece> pieces;
        int refused = 0;
        for (int step = 0; step < 20'000; ++step) {
            if (!pieces.empty() && random() % 100 < (step / 2000 % 2 == 0 ? 40U : 60U)) {
                const std::size_t index = random() % pieces.size();
                const Piece piece = pieces[index];
                for (std::size_t i = 0; i < piece.size; ++i)
                    ASSERT_EQ(piece.start[i], piece.mark);
                heap.release(piece.start);
                pieces[index] = pieces.back();
                pieces.pop_back();
            } else {
                const std::size_t alignment = random() % 8 == 0 ? std::size_t{1} << (random() % 11) : 16;
                const std::size_t size = random() % 10 == 0 ? random() % 30'000 : random() % 400;
                auto* const start = static_cast<std::byte*>(heap.allocate(size, alignment));
                if (start == nullptr) {
                    ++refused;
                    continue;
                }
                ASSERT_EQ(reinterpret_cast<std::uintptr_t>(start) % alignment, 0U);
                ASSERT_GE(start, span.data());
                ASSERT_LE(start + size, span.data() + span.size());
                const auto mark = static_cast<std::byte>(random());
                std::fill(start, start + size, mark);
                pieces.push_back({start, size, mark});
            }
        }
        EXPECT_GT(refused, 0) << "the heap was never full";
        for (const Piece& piece : pieces)
            heap.release(piece.start);
        EXPECT_EQ(heap.used_bytes(), 0U);
        EXPECT_LE(heap.peak_bytes(), span.size());
        EXPECT_NE(heap.allocate(span.size() - 64), nullptr) << "the pieces did not melt together";
    }
}

TEST(BlockHeap, TheLastBytesAreServedToo)
{
    // Requests near the size of the only hole, which a search by rounded-up size alone would refuse.
    for (std::size_t size = 64; size < 3000; size += 16) {
        std::vector<std::byte> memory(size + 16);
        const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
        BlockHeap heap{std::span{memory}.subspan((16 - address % 16) % 16).first(size)};
        EXPECT_EQ(heap.allocate(size - 16 + 1), nullptr) << size;
        void* const all = heap.allocate(size - 16);
        EXPECT_NE(all, nullptr) << size;
        EXPECT_EQ(heap.peak_bytes(), size);
        heap.release(all);
    }
}

TEST(BlockHeap, AnEmptySpanRefusesEverything)
{
    BlockHeap heap{{}};
    EXPECT_EQ(heap.allocate(0), nullptr);
    EXPECT_EQ(heap.allocate(1), nullptr);
    int elsewhere = 0;
    heap.release(&elsewhere);
    heap.release(nullptr);
}

} // namespace
} // namespace dicot
