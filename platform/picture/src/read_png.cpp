#include "decode.h"

#include <png.h>

#include <csetjmp>

namespace dicot {
namespace {

/// All that lives across libpng's jumps out of an error; the jumps cross no frame with a destructor to run.
struct PngRead
{
    ByteSource& source;
    PictureRequest& request;
    png_structp png = nullptr;
    png_infop info = nullptr;
    Status why;
    std::jmp_buf escape;
};

[[noreturn]] void leave(PngRead& read, const Status& why) noexcept
{
    read.why = why;
    std::longjmp(read.escape, 1);
}

[[noreturn]] void on_error(png_structp png, png_const_charp detail)
{
    auto& read = *static_cast<PngRead*>(png_get_error_ptr(png));
    leave(read, damaged(read.source.name(), detail));
}

/// Warnings concern chunks that say nothing about the pixels.
void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep into, std::size_t count)
{
    auto& read = *static_cast<PngRead*>(png_get_io_ptr(png));
    if (!read.source.read({reinterpret_cast<std::byte*>(into), count}))
        leave(read, ended_early(read.source));
}

/// Whatever the file holds becomes 8 bits R, G, B.
void ask_for_rgb8(PngRead& read)
{
    png_set_expand(read.png);
    png_set_gray_to_rgb(read.png);
    png_set_scale_16(read.png);
    const bool transparent = (png_get_color_type(read.png, read.info) & PNG_COLOR_MASK_ALPHA) != 0 ||
                             png_get_valid(read.png, read.info, PNG_INFO_tRNS) != 0;
    if (transparent) {
        const png_color_16 black{};
        png_set_background(read.png, &black, PNG_BACKGROUND_GAMMA_SCREEN, 0, 1.0);
    }
}

void read_pixels(PngRead& read)
{
    ask_for_rgb8(read);
    const int passes = png_set_interlace_handling(read.png);
    png_read_update_info(read.png, read.info);
    if (png_get_rowbytes(read.png, read.info) != static_cast<std::size_t>(read.request.size.width) * sizeof(Rgb8))
        leave(read, failure(Fault::kSoftware, "%s: libpng does not give 8-bit RGB", read.source.name()));
    for (int pass = 0; pass < passes; ++pass)
        for (int y = 0; y < read.request.size.height; ++y)
            png_read_row(read.png, reinterpret_cast<png_bytep>(read.request.into->row(y)), nullptr);
    png_read_end(read.png, nullptr);
}

void run(PngRead& read)
{
    if (setjmp(read.escape) != 0)
        return;
    read.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &read, &on_error, &on_warning);
    read.info = read.png == nullptr ? nullptr : png_create_info_struct(read.png);
    if (read.info == nullptr)
        leave(read, failure(Fault::kOsError, "%s: no memory for decoding; end other programs", read.source.name()));
    png_set_read_fn(read.png, &read, &on_read);
    // Of the optional chunks only tRNS says something about the pixels; the rest is not even unpacked.
    png_set_keep_unknown_chunks(read.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_user_limits(read.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX); // accept_size() has a better sentence
    png_set_chunk_cache_max(read.png, 16);
    png_set_chunk_malloc_max(read.png, 1 << 20);
    png_read_info(read.png, read.info);
    const Status fits = accept_size(read.source.name(), png_get_image_width(read.png, read.info),
                                    png_get_image_height(read.png, read.info), read.request);
    if (!fits.ok())
        leave(read, fits);
    if (read.request.into != nullptr)
        read_pixels(read);
}

} // namespace

Status decode_png(ByteSource& source, PictureRequest& request) noexcept
{
    PngRead read{.source = source, .request = request, .png = nullptr, .info = nullptr, .why = {}, .escape = {}};
    run(read);
    png_destroy_read_struct(&read.png, &read.info, nullptr);
    return read.why;
}

} // namespace dicot
