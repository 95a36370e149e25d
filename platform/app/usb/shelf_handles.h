// The numbers by which hosts know what stands on the shelf.
#pragma once

#include "dicot/mtp/object_source.h"
#include "dicot/shelf/shelf_index.h"

#include <cstdint>

namespace dicot::app {

inline constexpr mtp::Handle kBoardFolder = 1;
inline constexpr int kSumsMember = 15;

constexpr mtp::Handle handle_of_day(std::uint32_t day) noexcept
{
    return 0x80000000U | day;
}
/// Member 0: the folder.
constexpr mtp::Handle handle_of(std::int64_t sequence, int member) noexcept
{
    return static_cast<mtp::Handle>(sequence << 4 | member);
}
static_assert(handle_of(ShelfIndex::kMostSequence, kSumsMember) == 0x7FFFFFFFU);

constexpr bool is_day(mtp::Handle handle) noexcept
{
    return (handle & 0x80000000U) != 0;
}
constexpr std::uint32_t day_of(mtp::Handle handle) noexcept
{
    return handle & 0x7FFFFFFFU;
}
/// 0: of none.
constexpr std::int64_t sequence_of(mtp::Handle handle) noexcept
{
    return is_day(handle) ? 0 : handle >> 4;
}
constexpr int member_of(mtp::Handle handle) noexcept
{
    return static_cast<int>(handle & 15U);
}

} // namespace dicot::app
