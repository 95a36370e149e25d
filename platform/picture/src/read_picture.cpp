#include "dicot/picture/read_picture.h"

#include "by_magic.h"
#include "decode.h"
#include "dicot/os/shown_path.h"

namespace dicot {

Status accept_size(const char* name, std::uint64_t width, std::uint64_t height, PictureRequest& request) noexcept
{
    const char* shown = shown_path(name);
    if (width == 0 || height == 0)
        return damaged(name, "it has no pixels");
    if (width > kMaxPictureSide || height > kMaxPictureSide || width * height > std::uint64_t{kMaxPicturePixels})
        return failure(Fault::kBadData,
                       "%s: the picture is %llu x %llu, the largest is %d on a side and %d megapixels; scale it down",
                       shown, static_cast<unsigned long long>(width), static_cast<unsigned long long>(height),
                       kMaxPictureSide, static_cast<int>(kMaxPicturePixels / 1'000'000));
    request.size = {static_cast<int>(width), static_cast<int>(height)};
    if (request.into != nullptr &&
        (request.into->width != request.size.width || request.into->height != request.size.height))
        return failure(Fault::kBadData,
                       "%s: the picture is %d x %d where %d x %d is expected; give pictures of the same size", shown,
                       request.size.width, request.size.height, request.into->width, request.into->height);
    return {};
}

Status ended_early(const ByteSource& source) noexcept
{
    if (!source.trouble().ok())
        return source.trouble();
    return failure(Fault::kBadData, "%s: the picture is cut short; copy or take it again", shown_path(source.name()));
}

Status damaged(const char* name, const char* detail) noexcept
{
    return failure(Fault::kBadData, "%s: the picture is damaged (%s); copy or take it again", shown_path(name), detail);
}

namespace {

constexpr Format<PictureRequest> kFormats[] = {
    {"\x89PNG\r\n\x1a\n", &decode_png},
    {"\xff\xd8\xff", &decode_jpeg},
    {"P2", &decode_pnm},
    {"P3", &decode_pnm},
    {"P5", &decode_pnm},
    {"P6", &decode_pnm},
};

Status decode(ByteSource& source, PictureRequest& request) noexcept
{
    return decode_by_magic<PictureRequest>(source, kFormats, request, "copy or take the picture again",
                                           "is no picture that dicot reads; convert it to PNG, JPEG or PPM");
}

} // namespace

Result<PictureSize> jpeg_luma(std::span<const std::byte> file, const char* name, LumaRowSink sink) noexcept
{
    constexpr Format<PictureRequest> kJpeg[] = {{"\xff\xd8\xff", &decode_jpeg}};
    ByteSource source{file, name};
    PictureRequest request{.luma = &sink};
    TRY(decode_by_magic<PictureRequest>(source, kJpeg, request, "take the picture again", "is no JPEG"));
    return request.size;
}

Result<PictureSize> picture_size(const char* path) noexcept
{
    InputFile file;
    TRY(file.open(path));
    ByteSource source{file};
    PictureRequest request;
    TRY(decode(source, request));
    return request.size;
}

Status read_picture(const char* path, ImageView<Rgb8> into) noexcept
{
    InputFile file;
    TRY(file.open(path));
    ByteSource source{file};
    PictureRequest request{.into = &into};
    return decode(source, request);
}

Result<PictureSize> picture_size_bytes(std::span<const std::byte> file, const char* name) noexcept
{
    ByteSource source{file, name};
    PictureRequest request;
    TRY(decode(source, request));
    return request.size;
}

Status read_picture_bytes(std::span<const std::byte> file, const char* name, ImageView<Rgb8> into) noexcept
{
    ByteSource source{file, name};
    PictureRequest request{.into = &into};
    return decode(source, request);
}

} // namespace dicot
