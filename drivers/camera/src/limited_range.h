// BT.601 in its limited range, in 1/65536: what YUYV and NV12 mean.
#pragma once

#include <algorithm>
#include <cstdint>

namespace dicot {

constexpr std::int32_t kLumaGain = 76309;   ///< 255 / 219
constexpr std::int32_t kRedFromV = 104597;  ///< 1.402 * 255 / 224
constexpr std::int32_t kGreenFromU = 25675; ///< 0.344136 * 255 / 224
constexpr std::int32_t kGreenFromV = 53279; ///< 0.714136 * 255 / 224
constexpr std::int32_t kBlueFromU = 132201; ///< 1.772 * 255 / 224
static_assert(kLumaGain * 239 + kBlueFromU * 127 < INT32_MAX / 2);

/// Rounded to the nearest, halves up, and held to 0 .. 255.
constexpr std::uint8_t channel_of(std::int32_t value_q16) noexcept
{
    return static_cast<std::uint8_t>(std::clamp((value_q16 + 32768) >> 16, 0, 255));
}

constexpr std::uint8_t full_range_luma(std::uint8_t y) noexcept
{
    return channel_of(kLumaGain * (y - 16));
}

} // namespace dicot
