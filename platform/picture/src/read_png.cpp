#include "decode.h"
#include "png_reader.h"

namespace dicot {
namespace {

/// Whatever the file holds becomes 8 bits R, G, B.
void ask_for_rgb8(PngReader& reader)
{
    png_set_expand(reader.png);
    png_set_gray_to_rgb(reader.png);
    png_set_scale_16(reader.png);
    const bool transparent = (png_get_color_type(reader.png, reader.info) & PNG_COLOR_MASK_ALPHA) != 0 ||
                             png_get_valid(reader.png, reader.info, PNG_INFO_tRNS) != 0;
    if (transparent) {
        const png_color_16 black{};
        png_set_background(reader.png, &black, PNG_BACKGROUND_GAMMA_SCREEN, 0, 1.0);
    }
}

void read_pixels(PngReader& reader, const ImageView<Rgb8>& into)
{
    ask_for_rgb8(reader);
    const int passes = png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    if (png_get_rowbytes(reader.png, reader.info) != static_cast<std::size_t>(into.width) * sizeof(Rgb8))
        leave(reader, failure(Fault::kSoftware, "%s: libpng does not give 8-bit RGB", reader.source.name()));
    for (int pass = 0; pass < passes; ++pass)
        for (int y = 0; y < into.height; ++y)
            png_read_row(reader.png, reinterpret_cast<png_bytep>(into.row(y)), nullptr);
    png_read_end(reader.png, nullptr);
}

void read_picture_of(PngReader& reader, void* context)
{
    auto& request = *static_cast<PictureRequest*>(context);
    const Status fits = accept_size(reader.source.name(), png_get_image_width(reader.png, reader.info),
                                    png_get_image_height(reader.png, reader.info), request);
    if (!fits.ok())
        leave(reader, fits);
    if (request.into != nullptr)
        read_pixels(reader, *request.into);
}

} // namespace

Status decode_png(ByteSource& source, PictureRequest& request) noexcept
{
    return read_png(source, &read_picture_of, &request);
}

} // namespace dicot
