#include "functions.h"

#include "chain.h"

#include <algorithm>
#include <cstring>
#include <optional>

namespace dicot {
namespace {

// bDescriptorSubtype (UVC, table A-6).
constexpr std::uint8_t kInputHeader = 1;
constexpr std::uint8_t kFormatUncompressed = 4;
constexpr std::uint8_t kFrameUncompressed = 5;
constexpr std::uint8_t kFormatMjpeg = 6;
constexpr std::uint8_t kFrameMjpeg = 7;
constexpr std::uint8_t kFormatMpeg2 = 0x0A;
constexpr std::uint8_t kFormatDv = 0x0C;
constexpr std::uint8_t kFormatFrameBased = 0x10;
constexpr std::uint8_t kFormatStreamBased = 0x12;
constexpr std::uint8_t kFormatH264 = 0x13;
constexpr std::uint8_t kFormatVp8 = 0x16;

constexpr std::size_t kFrameHeadBytes = 26;

struct KnownGuid
{
    char fourcc[5];
    PixelFormat format;
};

// UVC Payload Uncompressed, table 2-1, and the greys that cameras use: a fourcc and the tail of Microsoft's GUIDs.
constexpr std::array<KnownGuid, 4> kGuids{{{"YUY2", PixelFormat::kYuyv},
                                           {"NV12", PixelFormat::kNv12},
                                           {"Y800", PixelFormat::kGrey},
                                           {"Y8  ", PixelFormat::kGrey}}};
constexpr std::array<std::uint8_t, 12> kGuidTail{0, 0, 0x10, 0, 0x80, 0, 0, 0xAA, 0, 0x38, 0x9B, 0x71};

std::optional<PixelFormat> format_of_guid(Bytes guid) noexcept
{
    if (std::memcmp(guid.data() + 4, kGuidTail.data(), kGuidTail.size()) != 0)
        return std::nullopt;
    for (const KnownGuid& known : kGuids)
        if (std::memcmp(guid.data(), known.fourcc, 4) == 0)
            return known.format;
    return std::nullopt;
}

class StreamingReader
{
public:
    explicit StreamingReader(UvcDevice& device) noexcept : device_(device) {}

    std::uint8_t endpoint() const noexcept { return endpoint_; }

    void read_class(Bytes one) noexcept
    {
        if (one.size() < 3)
            return;
        switch (u8_at(one, 2)) {
        case kInputHeader:
            if (endpoint_ == 0 && one.size() >= 7)
                endpoint_ = u8_at(one, 6);
            return;
        case kFormatUncompressed:
            frames_expected_ = kFrameUncompressed;
            open_format(one, uncompressed_format(one));
            return;
        case kFormatMjpeg:
            frames_expected_ = kFrameMjpeg;
            open_format(one, one.size() >= 11 && (u8_at(one, 9) & 1) == 0 ? std::optional{PixelFormat::kMjpeg}
                                                                          : std::nullopt);
            return;
        case kFormatMpeg2:
        case kFormatDv:
        case kFormatFrameBased:
        case kFormatStreamBased:
        case kFormatH264:
        case kFormatVp8:
            format_ = nullptr;
            ++device_.left_out;
            return;
        case kFrameUncompressed:
        case kFrameMjpeg:
            if (format_ != nullptr && u8_at(one, 2) == frames_expected_)
                read_frame(one);
            return;
        default:
            return;
        }
    }

    /// USB 2.0, 9.6.6; USB 3.2, 9.6.7.
    void read_endpoint(Bytes one, Bytes companion, std::uint8_t alternate) noexcept
    {
        if (one.size() < 7 || u8_at(one, 2) != endpoint_)
            return;
        const unsigned kind = u8_at(one, 3) & 3u;
        const unsigned interval = u8_at(one, 6);
        const bool bulk = kind == 2;
        const std::uint16_t packet = u16_at(one, 4);
        const unsigned more = (packet >> 11) & 3u; // additional transactions in a microframe
        std::uint32_t bytes = (packet & 0x7FFu) * (bulk ? 1 : 1 + more);
        if (!bulk && companion.size() >= 6)
            bytes = u16_at(companion, 4);
        const bool usable = (endpoint_ & 0x80) != 0 && (kind == 1 || bulk) && bytes > 0 && more < 3 &&
                            (bulk || (interval >= 1 && interval <= 16));
        if (!usable || device_.alternate_count == UvcDevice::kMostAlternates ||
            (device_.alternate_count > 0 && device_.bulk() != bulk)) {
            ++device_.left_out;
            return;
        }
        UvcAlternate& made = device_.alternates[device_.alternate_count++];
        made.setting = {alternate, bytes, bulk ? 1 : 1u << (interval - 1)};
        made.endpoint = endpoint_;
        made.bulk = bulk;
    }

private:
    static std::optional<PixelFormat> uncompressed_format(Bytes one) noexcept
    {
        if (one.size() < 27 || (u8_at(one, 25) & 1) != 0) // bmInterlaceFlags
            return std::nullopt;
        return format_of_guid(one.subspan(5, 16));
    }

    void open_format(Bytes one, std::optional<PixelFormat> format) noexcept
    {
        format_ = nullptr;
        if (!format || device_.format_count == UvcDevice::kMostFormats) {
            ++device_.left_out;
            return;
        }
        format_ = &device_.formats[device_.format_count++];
        *format_ = {u8_at(one, 3), *format, device_.frame_count, 0};
    }

    bool believable(const UvcFrame& frame) const noexcept
    {
        const bool pairs = format_->format == PixelFormat::kYuyv || format_->format == PixelFormat::kNv12;
        const bool rows_in_pairs = format_->format == PixelFormat::kNv12;
        return frame.width > 0 && frame.height > 0 && frame.width <= kMostUvcSide && frame.height <= kMostUvcSide &&
               !(pairs && frame.width % 2 != 0) && !(rows_in_pairs && frame.height % 2 != 0);
    }

    void read_frame(Bytes one) noexcept
    {
        if (one.size() < kFrameHeadBytes || device_.frame_count == UvcDevice::kMostFrames) {
            ++device_.left_out;
            return;
        }
        UvcFrame frame;
        frame.index = u8_at(one, 3);
        frame.width = u16_at(one, 5);
        frame.height = u16_at(one, 7);
        frame.most_bytes = u32_at(one, 17);
        if (!believable(frame) || !read_intervals(one, frame)) {
            ++device_.left_out;
            return;
        }
        device_.frames[device_.frame_count++] = frame;
        ++format_->frame_count;
    }

    /// bFrameIntervalType and what follows: 0 says least, most and step (UVC Payload Uncompressed, tables 3-3 and 3-4).
    bool read_intervals(Bytes one, UvcFrame& frame) noexcept
    {
        const std::size_t told = u8_at(one, 25);
        const std::size_t held = std::min(told == 0 ? std::size_t{3} : told, (one.size() - kFrameHeadBytes) / 4);
        const auto interval = [&](std::size_t i) { return u32_at(one, kFrameHeadBytes + 4 * i); };
        if (told == 0) {
            if (held < 3 || interval(0) == 0 || interval(0) > interval(1))
                return false;
            frame.continuous = true;
            frame.interval_count = 3;
            for (std::size_t i = 0; i < 3; ++i)
                frame.intervals_100ns[i] = interval(i);
            return true;
        }
        for (std::size_t i = 0; i < held; ++i) {
            if (interval(i) == 0 || frame.interval_count == UvcFrame::kMostIntervals)
                ++device_.left_out;
            else
                frame.intervals_100ns[frame.interval_count++] = interval(i);
        }
        return frame.interval_count > 0;
    }

    UvcDevice& device_;
    UvcFormat* format_ = nullptr; ///< where frames go; null while a format is skipped
    std::uint8_t frames_expected_ = 0;
    std::uint8_t endpoint_ = 0;
};

} // namespace

Status read_video_streaming(Bytes chain, std::uint8_t number, UvcDevice& device) noexcept
{
    StreamingReader reader(device);
    bool here = false;
    std::uint8_t alternate = 0;
    ChainWalk walk(chain);
    for (Bytes one = walk.next(); !one.empty(); one = walk.next()) {
        if (is_interface(one)) {
            const InterfaceHead head = interface_of(one);
            here = head.number == number && head.subclass == kVideoStreaming;
            alternate = head.alternate;
        } else if (here && type_of(one) == kClassInterface) {
            reader.read_class(one);
        } else if (here && type_of(one) == kEndpointDescriptor) {
            ChainWalk ahead = walk;
            const Bytes companion = ahead.next();
            reader.read_endpoint(
                one, !companion.empty() && type_of(companion) == kCompanionDescriptor ? companion : Bytes{}, alternate);
        }
    }
    if (reader.endpoint() == 0)
        return failure(Fault::kUnavailable, "its streaming interface %u has no input header (UVC 3.9.2.1)",
                       unsigned{number});
    if (device.frame_count == 0)
        return failure(Fault::kUnavailable,
                       "its streaming interface %u has no picture that dicot can read: YUY2, NV12, Y800 or MJPEG",
                       unsigned{number});
    if (device.alternate_count == 0)
        return failure(Fault::kUnavailable, "its streaming interface %u has no usable endpoint (USB 2.0, 9.6.6)",
                       unsigned{number});
    return {};
}

} // namespace dicot
