#include "recording.h"

#include "dicot/os/input_file.h"
#include "dicot/os/shown_path.h"
#include "dicot/picture/read_picture.h"

#include <array>
#include <charconv>
#include <optional>
#include <string_view>

namespace dicot::replay {
namespace {

/// The last WIDTHxHEIGHT in a file's name.
std::optional<PictureSize> size_in(std::string_view name) noexcept
{
    const auto digit = [&](std::size_t at) { return at < name.size() && name[at] >= '0' && name[at] <= '9'; };
    for (std::size_t x = name.rfind('x'); x != std::string_view::npos && x > 0; x = name.rfind('x', x - 1)) {
        std::size_t from = x;
        while (from > 0 && digit(from - 1))
            --from;
        PictureSize size;
        const char* end = name.data() + name.size();
        if (from < x && digit(x + 1) &&
            std::from_chars(name.data() + from, name.data() + x, size.width).ec == std::errc{} &&
            std::from_chars(name.data() + x + 1, end, size.height).ec == std::errc{})
            return size;
    }
    return std::nullopt;
}

Result<Recording> look_at_raw(const char* path, std::string_view name, std::uint64_t file_bytes) noexcept
{
    const std::optional<PictureSize> size = size_in(name);
    if (!size || size->width < 2 || size->width % 2 != 0 || size->height < 1 || size->width > kMaxPictureSide ||
        size->height > kMaxPictureSide)
        return failure(Fault::kBadData, "%s: a raw frame's name tells its size; call it like left-640x480.yuyv",
                       shown_path(path));
    const CameraMode mode{PixelFormat::kYuyv, size->width, size->height, 0};
    if (file_bytes != frame_bytes(mode))
        return failure(Fault::kBadData, "%s: has %llu bytes where YUYV of %d x %d has %zu; copy or record it again",
                       shown_path(path), static_cast<unsigned long long>(file_bytes), size->width, size->height,
                       frame_bytes(mode));
    return Recording{mode, frame_bytes(mode)};
}

bool is_jpeg(std::span<const std::byte> front) noexcept
{
    return front.size() >= 3 && front[0] == std::byte{0xFF} && front[1] == std::byte{0xD8} &&
           front[2] == std::byte{0xFF};
}

} // namespace

Result<Recording> look_at(const char* path) noexcept
{
    InputFile file;
    TRY(file.open(path));
    std::string_view name{path};
    name.remove_prefix(name.rfind('/') + 1); // npos + 1 is 0
    if (name.ends_with(".yuyv"))
        return look_at_raw(path, name, file.size_bytes());
    std::array<std::byte, 3> front{};
    const std::size_t got = TRY(file.read(front));
    const PictureSize size = TRY(picture_size(path));
    CameraMode mode{PixelFormat::kRgb24, size.width, size.height, 0};
    if (!is_jpeg(std::span{front}.first(got)))
        return Recording{mode, frame_bytes(mode)};
    mode.format = PixelFormat::kMjpeg;
    return Recording{mode, static_cast<std::size_t>(file.size_bytes())};
}

Result<std::size_t> read_frame(const char* path, const CameraMode& mode, std::span<std::byte> into) noexcept
{
    if (mode.format == PixelFormat::kRgb24) {
        static_assert(alignof(Rgb8) == 1);
        auto* pixels = static_cast<Rgb8*>(static_cast<void*>(into.data()));
        TRY(read_picture(path, {pixels, mode.width, mode.height}));
        return frame_bytes(mode);
    }
    InputFile file;
    TRY(file.open(path));
    const std::size_t got = TRY(file.read(into));
    const std::size_t wanted = frame_bytes(mode);
    if (file.size_bytes() > into.size() || (wanted != 0 && got != wanted) || (wanted == 0 && !is_jpeg(into.first(got))))
        return failure(Fault::kBadData, "%s: has changed since it was opened; start again", shown_path(path));
    return got;
}

void darken(const CameraMode& mode, std::span<std::byte> frame, unsigned light, unsigned full) noexcept
{
    const bool yuyv = mode.format == PixelFormat::kYuyv;
    for (std::size_t i = 0; i < frame.size(); ++i) {
        const int dark = !yuyv ? 0 : i % 2 == 0 ? 16 : 128;
        const int value = std::to_integer<int>(frame[i]) - dark;
        frame[i] = static_cast<std::byte>(dark + value * static_cast<int>(light) / static_cast<int>(full));
    }
}

} // namespace dicot::replay
