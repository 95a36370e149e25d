#include "buffer_judge.h"

#include <algorithm>
#include <cstdio>
#include <limits>

namespace dicot::v4l2 {
namespace {

bool pair_at(std::span<const std::byte> bytes, std::size_t at, unsigned first, unsigned second) noexcept
{
    return std::to_integer<unsigned>(bytes[at]) == first && std::to_integer<unsigned>(bytes[at + 1]) == second;
}

bool ends_as_jpeg(std::span<const std::byte> bytes) noexcept
{
    std::size_t end = bytes.size();
    while (end > 2 && bytes[end - 1] == std::byte{0})
        --end;
    return end >= 4 && pair_at(bytes, end - 2, 0xFF, 0xD9);
}

} // namespace

void judge(const v4l2_buffer& buffer, std::span<const std::byte> mapped, Frame& frame, std::span<char> flaw) noexcept
{
    const std::size_t used = buffer.bytesused;
    const std::size_t wanted = frame_bytes(frame.mode);
    frame.bytes = mapped.first(std::min(used, mapped.size()));
    const auto torn = [&](const char* format, auto... words) {
        frame.verdict = FrameVerdict::kTorn;
        std::snprintf(flaw.data(), flaw.size(), format, words...);
        frame.flaw = flaw.data();
    };
    if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0)
        return torn("error flag, %zu bytes", used);
    if (used == 0)
        return torn("%s", "no bytes");
    if (used > mapped.size())
        return torn("%zu bytes in a buffer of %zu", used, mapped.size());
    if (wanted != 0 && used != wanted)
        return torn("%zu of %zu bytes", used, wanted);
    if (frame.mode.format == PixelFormat::kMjpeg) {
        if (used < 4 || !pair_at(frame.bytes, 0, 0xFF, 0xD8))
            return torn("%s", "no start marker of a JPEG");
        if (!ends_as_jpeg(frame.bytes))
            return torn("no end marker after %zu bytes", used);
    }
    frame.verdict = FrameVerdict::kWhole;
    frame.flaw = "";
}

std::int64_t start_us(const v4l2_buffer& buffer, std::uint32_t interval_100ns, std::int64_t now_us) noexcept
{
    constexpr std::int64_t kOldest = 10'000'000;
    constexpr std::int64_t kMostSeconds = std::numeric_limits<std::int64_t>::max() / 2'000'000;
    const std::int64_t interval_us = interval_100ns / 10;
    const auto seconds = static_cast<std::int64_t>(buffer.timestamp.tv_sec);
    if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC && seconds >= 0 &&
        seconds < kMostSeconds) {
        const std::int64_t stamp = seconds * 1'000'000 + std::clamp<std::int64_t>(buffer.timestamp.tv_usec, 0, 999'999);
        const bool at_start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
        if (stamp <= now_us && stamp >= now_us - kOldest)
            return at_start ? stamp : stamp - interval_us;
    }
    return now_us - interval_us;
}

std::uint32_t lost_between(std::uint32_t expected, std::uint32_t sequence) noexcept
{
    const std::uint32_t ahead = sequence - expected;
    return ahead < 0x8000'0000U ? ahead : 0;
}

} // namespace dicot::v4l2
