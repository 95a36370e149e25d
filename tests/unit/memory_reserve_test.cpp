// Blocks of pages out of a reserve.
#include "dicot/os/memory_reserve.h"

#include "dicot/os/memory_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace dicot {
namespace {

constexpr std::size_t kFrame = 100'000;

bool lies_in(const MemoryBlock& block, const MemoryBlock& whole)
{
    return block.bytes().data() >= whole.bytes().data() &&
           block.bytes().data() + block.bytes().size() <= whole.bytes().data() + whole.bytes().size();
}

TEST(MemoryReserve, GivesZeroedPagesAgainAndAgainAndNeverTheSystems)
{
    const MemoryBlock whole = MemoryBlock::map(2 * MemoryReserve::bytes_for(kFrame)).value();
    const MemoryReserve reserve{whole.bytes()};
    for (int round = 0; round < 100; ++round) {
        const MemoryBlock first = MemoryBlock::map(kFrame).value();
        MemoryBlock second = MemoryBlock::map(kFrame, Pages::kResident).value();
        const MemoryBlock moved = std::move(second);
        for (const MemoryBlock* block : {&first, &moved}) {
            ASSERT_TRUE(lies_in(*block, whole)) << round;
            ASSERT_EQ(block->bytes().size(), kFrame);
            ASSERT_EQ(reinterpret_cast<std::uintptr_t>(block->bytes().data()) % MemoryReserve::kPageBytes, 0U);
            ASSERT_TRUE(std::ranges::all_of(block->bytes(), [](std::byte byte) { return byte == std::byte{0}; }));
            std::memset(block->bytes().data(), 0x5A, kFrame);
        }
    }
    EXPECT_EQ(reserve.used_bytes(), 0U);
    EXPECT_EQ(reserve.refused(), 0U);
    EXPECT_LE(reserve.peak_bytes(), whole.bytes().size());
}

TEST(MemoryReserve, AFullOneRefusesWithASentence)
{
    const MemoryBlock whole = MemoryBlock::map(MemoryReserve::bytes_for(kFrame)).value();
    const MemoryReserve reserve{whole.bytes()};
    const MemoryBlock first = MemoryBlock::map(kFrame).value();
    const auto second = MemoryBlock::map(kFrame);
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(second.status().fault(), Fault::kOsError);
    EXPECT_NE(std::strstr(second.status().message(), "98 KiB"), nullptr) << second.status().message();
    EXPECT_EQ(reserve.refused(), 1U);
}

TEST(MemoryReserve, BlocksFromBeforeItGoBackToTheSystemAndLaterOnesComeFromThere)
{
    const MemoryBlock whole = MemoryBlock::map(MemoryReserve::bytes_for(kFrame)).value();
    {
        MemoryBlock before = MemoryBlock::map(kFrame).value();
        const MemoryReserve reserve{whole.bytes()};
        before = MemoryBlock::map(kFrame).value();
        EXPECT_TRUE(lies_in(before, whole));
        before = {};
        EXPECT_EQ(reserve.used_bytes(), 0U);
    }
    EXPECT_FALSE(lies_in(MemoryBlock::map(kFrame).value(), whole));
}

} // namespace
} // namespace dicot
