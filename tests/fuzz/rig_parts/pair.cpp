// The best pair is the nearest of all, as a plain search finds it.
#include "parts.h"

#include "dicot/camera_rig/pairing.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace dicot::fuzz {
namespace {

constexpr std::uint64_t kMostSkew = std::numeric_limits<std::int64_t>::max();

std::vector<FrameTime> read_burst(Numbers& numbers, int count)
{
    std::vector<FrameTime> burst;
    std::int64_t now_us = 0;
    std::uint32_t sequence = 0;
    for (int i = 0; i < count; ++i) {
        const std::uint8_t how = numbers.byte();
        sequence = (how & 0x10) != 0 ? numbers.number() : sequence + (how >> 5);
        now_us = (how & 8) != 0 ? static_cast<std::int64_t>(numbers.large()) : (now_us & 0xffffffffff) + numbers.word();
        burst.push_back({now_us, static_cast<FrameVerdict>(how % 3), sequence});
    }
    return burst;
}

std::uint64_t apart(std::int64_t a, std::int64_t b)
{
    const auto large = static_cast<std::uint64_t>(std::max(a, b));
    return large - static_cast<std::uint64_t>(std::min(a, b));
}

void require_count(const BurstCount& count, const std::vector<FrameTime>& burst)
{
    const auto having = [&burst](FrameVerdict verdict) {
        return static_cast<std::uint32_t>(std::ranges::count(burst, verdict, &FrameTime::verdict));
    };
    require(count.frames == burst.size() && count.whole == having(FrameVerdict::kWhole));
    require(count.torn == having(FrameVerdict::kTorn) && count.cancelled == having(FrameVerdict::kCancelled));
}

void require_nearest(const Pairing& got, const std::vector<FrameTime>& left, const std::vector<FrameTime>& right)
{
    const FrameTime& l = left[static_cast<std::size_t>(got.left)];
    const FrameTime& r = right[static_cast<std::size_t>(got.right)];
    require(l.verdict == FrameVerdict::kWhole && r.verdict == FrameVerdict::kWhole);
    const std::uint64_t taken = apart(l.start_us, r.start_us);
    for (const FrameTime& one : left)
        for (const FrameTime& other : right) {
            if (one.verdict != FrameVerdict::kWhole || other.verdict != FrameVerdict::kWhole)
                continue;
            const std::uint64_t these = apart(one.start_us, other.start_us);
            require(std::min(taken, kMostSkew) <= these);
            if (these == taken && taken < kMostSkew)
                require(std::max(one.start_us, other.start_us) <= std::max(l.start_us, r.start_us));
        }
    if (taken <= kMostSkew)
        require(got.skew_us ==
                (r.start_us >= l.start_us ? static_cast<std::int64_t>(taken) : -static_cast<std::int64_t>(taken)));
}

} // namespace

void pair(Numbers& numbers)
{
    const std::uint8_t counts = numbers.byte();
    const auto limit_us = static_cast<std::int64_t>(numbers.number()) - 1000;
    const std::vector<FrameTime> left = read_burst(numbers, counts & 15);
    const std::vector<FrameTime> right = read_burst(numbers, counts >> 4);
    const Pairing got = best_pair(left, right);
    require_count(got.left_count, left);
    require_count(got.right_count, right);
    require(got.found() == (got.left_count.whole > 0 && got.right_count.whole > 0));
    const Status verdict = judge_pairing(got, limit_us);
    if (got.found())
        require_nearest(got, left, right);
    const bool near_enough = got.found() && got.skew_us <= limit_us && got.skew_us >= -limit_us;
    require(verdict.ok() == near_enough);
    if (!verdict.ok()) {
        require(verdict.fault() == Fault::kTryAgain);
        require_sentence(verdict.message());
    }
}

} // namespace dicot::fuzz
