// What a file keeps of a point: its place exactly, colour and confidence rounded (storage/README.md says why).
#pragma once

#include "dicot/base/cloud.h"

#include <cstdint>

namespace dicot {

/// Colour channels are kept as multiples of 5: 0 and 255 stay what they are, the rest is off by 2 at most.
inline constexpr int kColourStep = 5;
inline constexpr int kMostColourError = 2;
/// Confidences are kept as one of 16, 17/255 apart: off by 8/255 at most.
inline constexpr int kConfidenceBits = 4;
inline constexpr int kConfidenceStep = 17;
inline constexpr int kMostConfidenceError = 8;
static_assert(255 % kColourStep == 0 && kConfidenceStep * ((1 << kConfidenceBits) - 1) == 255);

constexpr std::uint8_t stored_channel(std::uint8_t value)
{
    return static_cast<std::uint8_t>((value + kColourStep / 2) / kColourStep * kColourStep);
}

/// 0 .. 15
constexpr std::uint8_t stored_confidence(std::uint8_t value)
{
    return static_cast<std::uint8_t>((value + kConfidenceStep / 2) / kConfidenceStep);
}

/// The point that decode_cloud() gives back for `point`. Stored once more, it stays as it is.
constexpr CloudPoint as_stored(const CloudPoint& point)
{
    const Rgb8& colour = point.colour;
    return {point.x,
            point.y,
            point.z,
            {stored_channel(colour.r), stored_channel(colour.g), stored_channel(colour.b)},
            static_cast<std::uint8_t>(stored_confidence(point.confidence) * kConfidenceStep)};
}

} // namespace dicot
