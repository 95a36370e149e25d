#include "png_reader.h"

#include "decode.h"

namespace dicot {
namespace {

[[noreturn]] void on_error(png_structp png, png_const_charp detail)
{
    auto& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
    leave(reader, damaged(reader.source.name(), detail));
}

/// Warnings concern chunks that say nothing about the pixels.
void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep into, std::size_t count)
{
    auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (!reader.source.read({reinterpret_cast<std::byte*>(into), count}))
        leave(reader, ended_early(reader.source));
}

void run(PngReader& reader, void (*body)(PngReader& reader, void* context), void* context)
{
    if (setjmp(reader.escape) != 0)
        return;
    reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, &on_error, &on_warning);
    reader.info = reader.png == nullptr ? nullptr : png_create_info_struct(reader.png);
    if (reader.info == nullptr)
        leave(reader, failure(Fault::kOsError, "%s: no memory for decoding; end other programs", reader.source.name()));
    png_set_read_fn(reader.png, &reader, &on_read);
    // Of the optional chunks only tRNS says something about the pixels; the rest is not even unpacked.
    png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_user_limits(reader.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX); // accept_size() has a better sentence
    png_set_chunk_cache_max(reader.png, 16);
    png_set_chunk_malloc_max(reader.png, 1 << 20);
    png_read_info(reader.png, reader.info);
    body(reader, context);
}

} // namespace

void leave(PngReader& reader, const Status& why) noexcept
{
    reader.why = why;
    std::longjmp(reader.escape, 1);
}

Status read_png(ByteSource& source, void (*body)(PngReader& reader, void* context), void* context) noexcept
{
    PngReader reader{.source = source, .png = nullptr, .info = nullptr, .why = {}, .escape = {}};
    run(reader, body, context);
    png_destroy_read_struct(&reader.png, &reader.info, nullptr);
    return reader.why;
}

} // namespace dicot
