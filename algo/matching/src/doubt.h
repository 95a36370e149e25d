// How sure a refined disparity is.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace dicot::matching {

/// Of which nobody can say how good it is.
inline constexpr std::int16_t kHopeless = INT16_MAX;
/// With so much doubt_of_value() there is no value. In 1/256, as all doubt.
inline constexpr int kMostDoubt = -1318;
/// Nobody takes a plane with more doubt from a neighbour (without doubt_of_winner()).
inline constexpr int kDoubtfulPlane = -400;

/// log2, 8 fraction bits, straight between powers of two; 0 for 0.
inline int log2_q8(std::uint64_t x)
{
    const int exponent = std::max(static_cast<int>(std::bit_width(x)) - 1, 0);
    return (exponent << 8) + static_cast<int>((x << 8 >> exponent) & 255);
}

// Doubt is the logarithm of the odds that a leaf's depth is wrong, times a factor: fitted (logistic regression) to the
// rendered plants, where the shares of one species come out alike without it. Shares are in 1/64.

/// A shift is doubtful where the pictures differ at it, `variance` in (1/16 grey level)^2, and where there is little
/// texture for so many neighbours: `support` is their weight, 127 each.
inline std::int16_t doubt_of_shift(std::int64_t variance, std::int64_t texture, std::int64_t support)
{
    constexpr int kOne = 256; // (1/16 grey level)^2 in 1 grey level^2
    constexpr int kTextureShare = 51, kSupportShare = 52;
    const int differs = log2_q8(static_cast<std::uint64_t>(std::max<std::int64_t>(variance, 0) + kOne)) - (8 << 8);
    const int tells = log2_q8(static_cast<std::uint64_t>(texture + 5));
    const int alike = log2_q8(static_cast<std::uint64_t>(support + 127) * 256 / 127) - (8 << 8);
    return static_cast<std::int16_t>(differs + (alike * kSupportShare - tells * kTextureShare) / 64);
}

/// A plane is doubtful where few of the neighbours asked are on it, and where those are not quite: `deviation` is their
/// mean distance, 1/4096 px.
inline int doubt_of_plane(std::int64_t agreed, std::int64_t asked, std::int64_t deviation)
{
    constexpr int kAlone = 2381; // 9.3 for all
    constexpr int kUneven = 826; // 3.2 a px
    return static_cast<int>(deviation * kUneven / 4096 - agreed * kAlone / asked);
}

/// So is what ended far from the winner, 1/256 px, and a winner with a rival: `margin` is its confidence.
inline int doubt_of_winner(int moved, int margin)
{
    constexpr int kFar = 8 << 8, kMovedShare = 48, kMarginShare = 23;
    const int away = log2_q8(static_cast<std::uint64_t>(std::min(moved, kFar) + 256)) - (8 << 8);
    return (away * kMovedShare - log2_q8(static_cast<std::uint64_t>(margin + 1)) * kMarginShare) / 64;
}

/// Decides whether there is a value: `least` is the least doubt of the neighbours on the plane. A plane of `slope`,
/// 1/4096 px a px, is seen by fewer neighbours, and less evenly, than one that is as true and faces the cameras.
inline int doubt_of_value(int own, int least, int slope)
{
    constexpr int kSteep = 4096 / 2, kSlopeShare = 4;
    return (own + least) / 2 - std::min(slope, kSteep) * kSlopeShare * 256 / 4096;
}

/// What a neighbour counts, at most, that has no value or is of another surface.
inline constexpr int kDoubtOfOthers = -430;

/// Confidence is about depth: a pixel of disparity is the more of it the farther the surface, with the square of the
/// distance. `doubt` is the mean of the neighbours', `disparity` and the `top` of the range have the same unit.
inline std::uint8_t confidence_of(int doubt, std::int64_t disparity, std::int64_t top)
{
    constexpr int kFarShare = 3; // twice as far is as bad as three times 256 more doubt
    constexpr int kSurest = -14 * 256, kRange = 18 * 256;
    const int away = log2_q8(static_cast<std::uint64_t>(top)) -
                     log2_q8(static_cast<std::uint64_t>(std::max<std::int64_t>(disparity, 1)));
    return static_cast<std::uint8_t>(std::clamp(255 - (doubt + kFarShare * away - kSurest) * 255 / kRange, 1, 255));
}

} // namespace dicot::matching
