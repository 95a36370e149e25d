#include "dicot/base/arena.h"
#include "dicot/base/cloud.h"
#include "dicot/base/crc32.h"
#include "dicot/base/disparity.h"
#include "dicot/base/exact_math.h"
#include "dicot/base/status.h"
#include "dicot/base/work.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

namespace dicot {
namespace {

TEST(ExactMath, ExpAgreesWithTheLibraryTo14Digits)
{
    for (double x = -40.0; x <= 40.0; x += 0.037)
        EXPECT_NEAR(exact_exp(x) / std::exp(x), 1.0, 1e-14) << x;
}

TEST(ExactMath, LogAgreesWithTheLibraryTo14Digits)
{
    for (double x = 1e-300; x < 1e300; x *= 1.37)
        EXPECT_NEAR(exact_log(x), std::log(x), 1e-14 * std::max(1.0, std::abs(std::log(x)))) << x;
    EXPECT_EQ(exact_log(1.0), 0.0);
}

TEST(ExactMath, RootsAgreeWithTheLibraryTo14Digits)
{
    for (int n = 2; n <= 5; ++n)
        for (double x = 1e-6; x < 5000; x *= 1.37)
            EXPECT_NEAR(exact_root(x, n) / std::pow(x, 1.0 / n), 1.0, 1e-14) << x << " root " << n;
    EXPECT_EQ(exact_root(0.0, 3), 0.0);
}

TEST(Arena, MeasuringArenaAsksForExactlyWhatARealOneGives)
{
    const auto lay_out = [](Arena& arena) {
        (void)arena.take<std::uint8_t>(3);
        (void)arena.take<std::uint32_t>(1000);
    };
    Arena measure;
    lay_out(measure);
    EXPECT_TRUE(measure.measuring());

    alignas(Arena::kAlignment) std::array<std::byte, 8192> block{};
    Arena exact{std::span<std::byte>{block}.first(measure.peak())};
    lay_out(exact);
    EXPECT_FALSE(exact.overrun());
    Arena small{std::span<std::byte>{block}.first(measure.peak() - 1)};
    lay_out(small);
    EXPECT_TRUE(small.overrun());
}

TEST(Arena, ANeedBeyondAllMemoryIsNotTakenForASmallOne)
{
    constexpr std::size_t kHalf = SIZE_MAX / 2 + 1;
    alignas(Arena::kAlignment) std::array<std::byte, 8192> block{};
    Arena measure, real{block};
    for (Arena* const arena : {&measure, &real}) {
        for (int i = 0; i < 2; ++i) // together 0, were they added as they are
            EXPECT_TRUE(arena->take<std::byte>(kHalf).empty());
        EXPECT_TRUE(arena->take<std::uint32_t>(kHalf).empty()) << "four times as many bytes are 0 too";
        EXPECT_TRUE(arena->take<std::byte>(64).empty());
        EXPECT_TRUE(arena->overrun());
        EXPECT_GT(arena->peak(), kHalf);
    }
}

Status fails()
{
    return failure(Fault::kNoInput, "%s: no such file", "left.png");
}
Result<int> doubled(Result<int> input)
{
    const int value = TRY(std::move(input));
    return 2 * value;
}

TEST(Status, TryPassesTheValueOnAndTheFaultUp)
{
    EXPECT_EQ(doubled(21).value(), 42);
    const Result<int> failed = doubled(fails());
    EXPECT_FALSE(failed.ok());
    EXPECT_EQ(failed.status().exit_code(), 66);
    EXPECT_STREQ(failed.status().message(), "left.png: no such file");
}

TEST(Crc32, TheCheckValueOfTheCatalogueAndEveryLength)
{
    const auto crc_of = [](std::string_view text) { return crc32(std::as_bytes(std::span{text})); };
    EXPECT_EQ(crc_of("123456789"), 0xCBF43926u);
    EXPECT_EQ(crc_of(""), 0u);
    // From zlib.
    EXPECT_EQ(crc_of("a"), 0xE8B7BE43u);
    EXPECT_EQ(crc_of("abc"), 0x352441C2u);
    EXPECT_EQ(crc_of("abcd"), 0xED82CD11u);
    EXPECT_EQ(crc_of("abcde"), 0x8587D865u);
}

TEST(Crew, AloneRunsEveryTaskOnceInOrder)
{
    Alone crew;
    int order = 0;
    crew.run(5, [&](int index) { EXPECT_EQ(index, order++); });
    EXPECT_EQ(order, 5);
}

} // namespace
} // namespace dicot
