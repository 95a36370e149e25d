#include "dicot/camera/decode_frame.h"

#include "dicot/picture/read_picture.h"
#include "limited_range.h"

#include <algorithm>
#include <cstring>

namespace dicot {
namespace {

using Bytes = std::span<const std::byte>;

std::uint8_t value(std::byte byte) noexcept
{
    return std::to_integer<std::uint8_t>(byte);
}

/// What a pair of U and V adds to its pixels.
struct Chroma
{
    std::int32_t red, green, blue;

    Chroma(std::byte u_byte, std::byte v_byte) noexcept
    {
        const std::int32_t u = value(u_byte) - 128;
        const std::int32_t v = value(v_byte) - 128;
        red = kRedFromV * v;
        green = -kGreenFromU * u - kGreenFromV * v;
        blue = kBlueFromU * u;
    }
    Rgb8 with(std::byte y) const noexcept
    {
        const std::int32_t luma = kLumaGain * (value(y) - 16);
        return {channel_of(luma + red), channel_of(luma + green), channel_of(luma + blue)};
    }
};

void decode_yuyv(Bytes bytes, ImageView<Rgb8> into) noexcept
{
    for (int y = 0; y < into.height; ++y) {
        Rgb8* pixel = into.row(y);
        for (int x = 0; x < into.width; x += 2, pixel += 2) {
            const Chroma chroma{bytes[1], bytes[3]};
            pixel[0] = chroma.with(bytes[0]);
            pixel[1] = chroma.with(bytes[2]);
            bytes = bytes.subspan(4);
        }
    }
}

void decode_nv12(Bytes bytes, ImageView<Rgb8> into) noexcept
{
    const auto width = static_cast<std::size_t>(into.width);
    const auto height = static_cast<std::size_t>(into.height);
    const Bytes luma = bytes.first(width * height);
    const Bytes pairs = bytes.subspan(width * height);
    for (std::size_t y = 0; y < height; ++y) {
        Rgb8* pixel = into.row(static_cast<int>(y));
        const Bytes row = luma.subspan(y * width, width);
        const Bytes colours = pairs.subspan(y / 2 * width, width);
        for (std::size_t x = 0; x < width; x += 2) {
            const Chroma chroma{colours[x], colours[x + 1]};
            pixel[x] = chroma.with(row[x]);
            pixel[x + 1] = chroma.with(row[x + 1]);
        }
    }
}

void decode_grey(Bytes bytes, ImageView<Rgb8> into) noexcept
{
    const auto width = static_cast<std::size_t>(into.width);
    for (int y = 0; y < into.height; ++y) {
        const Bytes row = bytes.subspan(static_cast<std::size_t>(y) * width, width);
        std::ranges::transform(row, into.row(y), [](std::byte grey) {
            return Rgb8{value(grey), value(grey), value(grey)};
        });
    }
}

void copy_rgb(Bytes bytes, ImageView<Rgb8> into) noexcept
{
    const std::size_t row = 3 * static_cast<std::size_t>(into.width);
    for (int y = 0; y < into.height; ++y)
        std::memcpy(into.row(y), bytes.subspan(static_cast<std::size_t>(y) * row, row).data(), row);
}

} // namespace

Status check_frame(const Frame& frame) noexcept
{
    const CameraMode& mode = frame.mode;
    const char* format = name_of(mode.format);
    if (frame.verdict != FrameVerdict::kWhole && frame.verdict != FrameVerdict::kWarmingUp)
        return failure(Fault::kBadData, "the frame is %s (%s); take another one", name_of(frame.verdict), frame.flaw);
    if (mode.width < 1 || mode.height < 1 || mode.width > kMaxPictureSide || mode.height > kMaxPictureSide ||
        std::int64_t{mode.width} * mode.height > kMaxPicturePixels)
        return failure(Fault::kBadData, "a frame of %d x %d pixels cannot be; choose another mode", mode.width,
                       mode.height);
    const bool pairs = mode.format == PixelFormat::kYuyv || mode.format == PixelFormat::kNv12;
    if ((pairs && mode.width % 2 != 0) || (mode.format == PixelFormat::kNv12 && mode.height % 2 != 0))
        return failure(Fault::kBadData, "%s cannot be %d x %d pixels large; choose a mode of even size", format,
                       mode.width, mode.height);
    if (mode.format == PixelFormat::kMjpeg) {
        const bool jpeg = frame.bytes.size() >= 2 && value(frame.bytes[0]) == 0xFF && value(frame.bytes[1]) == 0xD8;
        return jpeg ? Status{} : failure(Fault::kBadData, "the frame is no JPEG; take another one");
    }
    if (frame.bytes.size() != frame_bytes(mode))
        return failure(Fault::kBadData, "the frame has %zu bytes where %s of %d x %d has %zu; take another one",
                       frame.bytes.size(), format, mode.width, mode.height, frame_bytes(mode));
    return {};
}

Status decode_frame(const Frame& frame, ImageView<Rgb8> into) noexcept
{
    TRY(check_frame(frame));
    if (into.width != frame.mode.width || into.height != frame.mode.height)
        return failure(Fault::kBadData, "the frame is %d x %d where %d x %d is expected; choose that mode",
                       frame.mode.width, frame.mode.height, into.width, into.height);
    switch (frame.mode.format) {
    case PixelFormat::kYuyv:
        decode_yuyv(frame.bytes, into);
        return {};
    case PixelFormat::kNv12:
        decode_nv12(frame.bytes, into);
        return {};
    case PixelFormat::kGrey:
        decode_grey(frame.bytes, into);
        return {};
    case PixelFormat::kRgb24:
        copy_rgb(frame.bytes, into);
        return {};
    case PixelFormat::kMjpeg:
        return read_picture_bytes(frame.bytes, "the frame", into);
    }
    return failure(Fault::kBadData, "the frame has a format that dicot does not know");
}

} // namespace dicot
