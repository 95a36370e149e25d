#include "dicot/picture/read_map.h"

#include "by_magic.h"
#include "decode.h"
#include "decode_map.h"
#include "dicot/os/shown_path.h"

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

constexpr Format<MapRequest> kFormats[] = {
    {"\x89PNG\r\n\x1a\n", &decode_png_map},
    {"Pf", &decode_pfm},
};

Status decode(ByteSource& source, MapRequest& request) noexcept
{
    return decode_by_magic<MapRequest>(source, kFormats, request, "write or copy the map again",
                                       "is no disparity map; give a PFM of one channel or a grey PNG");
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
