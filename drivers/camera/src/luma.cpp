#include "dicot/camera/luma.h"

#include "dicot/camera/decode_frame.h"
#include "dicot/picture/jpeg_luma.h"
#include "limited_range.h"

namespace dicot {
namespace {

constexpr std::size_t kApart = 4;

struct Tally
{
    std::uint64_t sum = 0;
    std::uint64_t bright = 0;
    std::uint64_t count = 0;

    void add(std::uint8_t luma) noexcept
    {
        sum += luma;
        bright += luma >= kSaturatedLuma ? 1 : 0;
        ++count;
    }
    LumaFigures figures() const noexcept
    {
        if (count == 0)
            return {};
        return {static_cast<std::uint32_t>((sum * 256 + count / 2) / count),
                static_cast<std::uint32_t>((bright * 65536 + count / 2) / count), static_cast<std::uint32_t>(count)};
    }
};

std::uint8_t luma_at(const Frame& frame, std::size_t pixel) noexcept
{
    const auto at = [&](std::size_t i) { return std::to_integer<std::uint8_t>(frame.bytes[i]); };
    switch (frame.mode.format) {
    case PixelFormat::kYuyv:
        return full_range_luma(at(2 * pixel));
    case PixelFormat::kNv12:
        return full_range_luma(at(pixel));
    case PixelFormat::kGrey:
        return at(pixel);
    case PixelFormat::kRgb24:
        return luma_of(Rgb8{at(3 * pixel), at(3 * pixel + 1), at(3 * pixel + 2)});
    case PixelFormat::kMjpeg:
        break;
    }
    return 0;
}

} // namespace

Result<LumaFigures> luma_of(const Frame& frame) noexcept
{
    TRY(check_frame(frame));
    Tally tally;
    if (frame.mode.format == PixelFormat::kMjpeg) {
        const LumaRowSink sink{&tally, [](void* to, std::span<const std::uint8_t> row) {
                                   for (const std::uint8_t block : row)
                                       static_cast<Tally*>(to)->add(block);
                               }};
        const PictureSize size = TRY(jpeg_luma(frame.bytes, "the frame", sink));
        if (size.width != frame.mode.width || size.height != frame.mode.height)
            return failure(Fault::kBadData, "the frame is a JPEG of %d x %d where %d x %d is expected", size.width,
                           size.height, frame.mode.width, frame.mode.height);
        return tally.figures();
    }
    const auto width = static_cast<std::size_t>(frame.mode.width);
    const auto height = static_cast<std::size_t>(frame.mode.height);
    for (std::size_t y = 0; y < height; y += kApart)
        for (std::size_t x = 0; x < width; x += kApart)
            tally.add(luma_at(frame, y * width + x));
    return tally.figures();
}

LumaFigures luma_of(ImageView<const Rgb8> picture) noexcept
{
    Tally tally;
    for (int y = 0; y < picture.height; y += static_cast<int>(kApart))
        for (int x = 0; x < picture.width; x += static_cast<int>(kApart)) {
            tally.add(luma_of(picture.at(x, y)));
        }
    return tally.figures();
}

} // namespace dicot
