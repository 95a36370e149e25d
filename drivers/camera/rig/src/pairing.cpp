#include "dicot/camera_rig/pairing.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <limits>

namespace dicot {
namespace {

/// Devices may stamp frames with anything: what does not fit is the nearest that does.
std::int64_t difference(std::int64_t a, std::int64_t b) noexcept
{
    std::int64_t result = 0;
    if (!__builtin_sub_overflow(a, b, &result))
        return result;
    return a < b ? std::numeric_limits<std::int64_t>::min() : std::numeric_limits<std::int64_t>::max();
}

std::uint64_t size_of(std::int64_t value) noexcept
{
    const auto bits = static_cast<std::uint64_t>(value);
    return value < 0 ? 0 - bits : bits;
}

BurstCount count_of(std::span<const FrameTime> burst) noexcept
{
    BurstCount count;
    count.frames = static_cast<std::uint32_t>(burst.size());
    for (std::size_t i = 0; i < burst.size(); ++i) {
        count.whole += burst[i].verdict == FrameVerdict::kWhole;
        count.torn += burst[i].verdict == FrameVerdict::kTorn;
        count.cancelled += burst[i].verdict == FrameVerdict::kCancelled;
        if (i == 0)
            continue;
        const std::uint32_t ahead = burst[i].sequence - burst[i - 1].sequence;
        if (ahead > 1 && ahead <= std::numeric_limits<std::uint32_t>::max() / 2)
            count.lost += ahead - 1;
    }
    return count;
}

using BurstText = std::array<char, 96>;

/// "left torn 3, lost 1 of 6"
BurstText describe(const char* side, const BurstCount& count) noexcept
{
    BurstText text{};
    if (count.frames == 0)
        std::snprintf(text.data(), text.size(), "%s delivered no frame", side);
    else
        std::snprintf(text.data(), text.size(),
                      "%s torn %" PRIu32 ", cancelled %" PRIu32 ", lost %" PRIu64 " of %" PRIu64, side, count.torn,
                      count.cancelled, count.lost, count.frames + count.lost);
    return text;
}

} // namespace

Pairing best_pair(std::span<const FrameTime> left, std::span<const FrameTime> right) noexcept
{
    Pairing best;
    best.left_count = count_of(left);
    best.right_count = count_of(right);
    std::int64_t best_end_us = 0;
    for (std::size_t l = 0; l < left.size(); ++l) {
        for (std::size_t r = 0; r < right.size(); ++r) {
            if (left[l].verdict != FrameVerdict::kWhole || right[r].verdict != FrameVerdict::kWhole)
                continue;
            const std::int64_t skew_us = difference(right[r].start_us, left[l].start_us);
            const std::int64_t end_us = std::max(left[l].start_us, right[r].start_us);
            const bool nearer = size_of(skew_us) < size_of(best.skew_us);
            const bool later = size_of(skew_us) == size_of(best.skew_us) && end_us >= best_end_us;
            if (best.found() && !nearer && !later)
                continue;
            best.left = static_cast<int>(l);
            best.right = static_cast<int>(r);
            best.skew_us = skew_us;
            best_end_us = end_us;
        }
    }
    return best;
}

Status judge_pairing(const Pairing& pairing, std::int64_t most_skew_us) noexcept
{
    const BurstText left = describe("left", pairing.left_count);
    const BurstText right = describe("right", pairing.right_count);
    if (!pairing.found())
        return failure(Fault::kTryAgain, "no whole pair: %s; %s", left.data(), right.data());
    if (most_skew_us < 0 || size_of(pairing.skew_us) > size_of(most_skew_us))
        return failure(Fault::kTryAgain,
                       "no pair at one time: the least skew, %" PRIu64 " us, is above the limit of %" PRId64
                       " us; %s; %s",
                       size_of(pairing.skew_us), most_skew_us, left.data(), right.data());
    return {};
}

} // namespace dicot
