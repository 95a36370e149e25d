// The best pair out of two bursts, by the time at which the exposures began.
#pragma once

#include "dicot/base/status.h"
#include "dicot/camera/frame.h"

#include <cstdint>
#include <span>

namespace dicot {

/// What pairing asks of a frame.
struct FrameTime
{
    std::int64_t start_us = 0; ///< Frame::start_us
    FrameVerdict verdict = FrameVerdict::kCancelled;
    std::uint32_t sequence = 0; ///< Frame::sequence
};

/// What one camera delivered of a burst.
struct BurstCount
{
    std::uint32_t frames = 0; ///< whole + torn + cancelled
    std::uint32_t whole = 0;
    std::uint32_t torn = 0;
    std::uint32_t cancelled = 0;
    std::uint64_t lost = 0; ///< gaps of the sequence; it may wrap, and a step backwards (a new stream) is no gap
};

struct Pairing
{
    static constexpr int kNone = -1;

    int left = kNone; ///< place in its burst
    int right = kNone;
    std::int64_t skew_us = 0; ///< start of the right frame minus start of the left one
    BurstCount left_count;
    BurstCount right_count;

    bool found() const noexcept { return left != kNone; }
};

/// Of all pairs of whole frames the one with the least |skew|; of equal ones the one that ends later. Looks at every
/// pair: meant for bursts of some dozens. The order of frames in a burst matters to `lost` alone.
Pairing best_pair(std::span<const FrameTime> left, std::span<const FrameTime> right) noexcept;

/// Fault::kTryAgain: there is no whole pair, or its |skew| is above `most_skew_us`; the sentence has the figures.
Status judge_pairing(const Pairing& pairing, std::int64_t most_skew_us) noexcept;

} // namespace dicot
