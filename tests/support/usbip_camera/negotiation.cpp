#include "negotiation.h"

#include <linux/usb/video.h>

#include <algorithm>

namespace dicot::usbip {

namespace {

// Offsets in the structure, UVC 1.1 table 4-47.
constexpr std::size_t kFormatAt = 2;
constexpr std::size_t kFrameAt = 3;
constexpr std::size_t kIntervalAt = 4;
constexpr std::size_t kFrameBytesAt = 18;
constexpr std::size_t kPayloadBytesAt = 22;
constexpr std::size_t kClockAt = 26;
constexpr std::size_t kFramingAt = 30;
constexpr std::uint64_t kMicroframe100ns = 1250;

std::uint32_t number_at(std::span<const std::uint8_t> bytes, std::size_t at)
{
    return bytes[at] | std::uint32_t{bytes[at + 1]} << 8 | std::uint32_t{bytes[at + 2]} << 16 |
           std::uint32_t{bytes[at + 3]} << 24;
}

void put(Bytes& bytes, std::size_t at, std::uint32_t value)
{
    for (std::size_t i = 0; i < 4; ++i)
        bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint32_t distance(std::uint32_t a, std::uint32_t b)
{
    return a > b ? a - b : b - a;
}

} // namespace

std::uint32_t payload_bytes(const CameraModel& camera, std::uint32_t frame_bytes, std::uint32_t interval_100ns)
{
    if (camera.payload_policy == PayloadPolicy::kFixed)
        return static_cast<std::uint32_t>(camera.payload_bytes);
    if (camera.bulk)
        return kBulkPayloadBytes;
    const auto most = static_cast<std::uint32_t>(camera.alternates.back().bytes_a_microframe());
    if (camera.payload_policy == PayloadPolicy::kMost)
        return most;
    const std::uint64_t microframes = std::max<std::uint64_t>(interval_100ns / kMicroframe100ns, 1);
    const std::uint64_t need = (frame_bytes + microframes - 1) / microframes + kPayloadHeadBytes;
    for (const Alternate& alternate : camera.alternates)
        if (static_cast<std::uint64_t>(alternate.bytes_a_microframe()) >= need)
            return static_cast<std::uint32_t>(alternate.bytes_a_microframe());
    return most;
}

Negotiation::Negotiation(const CameraModel& camera) : camera_(camera), probed_(usual()), committed_(usual()) {}

Agreement Negotiation::usual() const
{
    Agreement agreement;
    agreement.interval_100ns = interval_of(camera_.rates_fps.front());
    return completed(agreement);
}

Agreement Negotiation::completed(Agreement wish) const
{
    wish.frame_bytes = camera_.formats[wish.format].modes[wish.mode].largest_frame_bytes;
    wish.payload_bytes = payload_bytes(camera_, wish.frame_bytes, wish.interval_100ns);
    return wish;
}

// Numbers start at 1; one that the camera does not have becomes the first.
Agreement Negotiation::mended(std::span<const std::uint8_t> data) const
{
    Agreement agreement;
    const std::size_t format = data[kFormatAt];
    agreement.format = format >= 1 && format <= camera_.formats.size() ? format - 1 : 0;
    const std::size_t mode = data[kFrameAt];
    agreement.mode = mode >= 1 && mode <= camera_.formats[agreement.format].modes.size() ? mode - 1 : 0;
    const std::uint32_t wanted = number_at(data, kIntervalAt);
    agreement.interval_100ns = interval_of(camera_.rates_fps.front());
    for (const int rate_fps : camera_.rates_fps)
        if (wanted != 0 && distance(interval_of(rate_fps), wanted) < distance(agreement.interval_100ns, wanted))
            agreement.interval_100ns = interval_of(rate_fps);
    return completed(agreement);
}

Bytes Negotiation::bytes_of(const Agreement& agreement) const
{
    Bytes bytes(kBytes11);
    bytes[kFormatAt] = static_cast<std::uint8_t>(agreement.format + 1);
    bytes[kFrameAt] = static_cast<std::uint8_t>(agreement.mode + 1);
    put(bytes, kIntervalAt, agreement.interval_100ns);
    put(bytes, kFrameBytesAt, agreement.frame_bytes);
    put(bytes, kPayloadBytesAt, agreement.payload_bytes);
    put(bytes, kClockAt, kClockHz);
    bytes[kFramingAt] = 3; // frame id and end of frame are told
    return bytes;
}

Reply Negotiation::request(int selector, int request, std::span<const std::uint8_t> data)
{
    const bool probe = selector == UVC_VS_PROBE_CONTROL;
    if (!probe && selector != UVC_VS_COMMIT_CONTROL)
        return Reply::stall();
    switch (request) {
    case UVC_SET_CUR: {
        if (data.size() != kBytes10 && data.size() != kBytes11)
            return Reply::stall();
        const Agreement agreement = mended(data);
        if (probe) {
            probed_ = agreement;
            return {};
        }
        if (data[kFormatAt] != agreement.format + 1 || data[kFrameAt] != agreement.mode + 1 ||
            number_at(data, kIntervalAt) != agreement.interval_100ns)
            return Reply::stall();
        committed_ = agreement;
        return {};
    }
    case UVC_GET_CUR:
        return Reply::of(bytes_of(probe ? probed_ : committed_));
    case UVC_GET_MIN:
    case UVC_GET_MAX:
    case UVC_GET_DEF:
        return probe ? Reply::of(bytes_of(usual())) : Reply::stall();
    case UVC_GET_LEN:
        return Reply::of({kBytes11, 0});
    case UVC_GET_INFO:
        return Reply::of({3});
    default:
        return Reply::stall();
    }
}

} // namespace dicot::usbip
