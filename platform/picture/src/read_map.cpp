#include "dicot/picture/read_map.h"

#include "decode.h"
#include "decode_map.h"
#include "dicot/os/shown_path.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace dicot {

Status accept_head(const char* name, std::uint64_t width, std::uint64_t height, MapKind kind,
                   MapRequest& request) noexcept
{
    PictureRequest size_alone;
    TRY(accept_size(name, width, height, size_alone));
    request.head = {size_alone.size, kind};
    const PictureSize& size = request.head.size;
    if (request.into != nullptr && (request.into->width != size.width || request.into->height != size.height))
        return failure(Fault::kBadData, "%s: the map is %d x %d where %d x %d is expected; give maps of the same size",
                       shown_path(name), size.width, size.height, request.into->width, request.into->height);
    return {};
}

namespace {

struct Format
{
    std::string_view magic;
    Status (*decode)(ByteSource&, MapRequest&) noexcept;
};

constexpr Format kFormats[] = {
    {"\x89PNG\r\n\x1a\n", &decode_png_map},
    {"Pf", &decode_pfm},
};

Status decode(ByteSource& source, MapRequest& request) noexcept
{
    const std::span<const std::byte> front = source.ahead();
    if (!source.trouble().ok())
        return source.trouble();
    if (front.empty())
        return failure(Fault::kBadData, "%s: the file is empty; write or copy the map again",
                       shown_path(source.name()));
    for (const Format& format : kFormats) {
        const std::size_t known = std::min(front.size(), format.magic.size());
        if (std::memcmp(front.data(), format.magic.data(), known) != 0)
            continue;
        return known == format.magic.size() ? format.decode(source, request) : ended_early(source);
    }
    return failure(Fault::kBadData, "%s: is no disparity map; give a PFM of one channel or a grey PNG",
                   shown_path(source.name()));
}

} // namespace

Result<MapHead> map_head(const char* path) noexcept
{
    InputFile file;
    TRY(file.open(path));
    ByteSource source{file};
    MapRequest request;
    TRY(decode(source, request));
    return request.head;
}

Status read_map(const char* path, double png_scale, ImageView<float> into) noexcept
{
    InputFile file;
    TRY(file.open(path));
    ByteSource source{file};
    MapRequest request{.into = &into, .png_scale = png_scale};
    return decode(source, request);
}

Result<MapHead> map_head_bytes(std::span<const std::byte> file, const char* name) noexcept
{
    ByteSource source{file, name};
    MapRequest request;
    TRY(decode(source, request));
    return request.head;
}

Status read_map_bytes(std::span<const std::byte> file, const char* name, double png_scale,
                      ImageView<float> into) noexcept
{
    ByteSource source{file, name};
    MapRequest request{.into = &into, .png_scale = png_scale};
    return decode(source, request);
}

} // namespace dicot
