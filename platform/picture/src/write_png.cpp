#include "dicot/os/output_file.h"
#include "dicot/os/shown_path.h"
#include "dicot/picture/read_picture.h"
#include "dicot/picture/write_picture.h"
#include "writable.h"

#include <png.h>

#include <bit>
#include <csetjmp>

namespace dicot {
namespace {

/// A picture as libpng takes it: rows of bytes.
struct Rows
{
    const std::uint8_t* first;
    std::ptrdiff_t stride_bytes;
    int width;
    int height;
    int bits;
    int colour_type;
};

/// All that lives across libpng's jumps out of an error; the jumps cross no frame with a destructor to run.
struct PngWrite
{
    ByteSink& sink;
    const char* name;
    const Rows& rows;
    png_structp png = nullptr;
    png_infop info = nullptr;
    Status why;
    std::jmp_buf escape;
};

[[noreturn]] void leave(PngWrite& write, const Status& why) noexcept
{
    write.why = why;
    std::longjmp(write.escape, 1);
}

[[noreturn]] void on_error(png_structp png, png_const_charp detail)
{
    auto& write = *static_cast<PngWrite*>(png_get_error_ptr(png));
    leave(write, failure(Fault::kSoftware, "%s: libpng cannot write it (%s)", shown_path(write.name), detail));
}

void on_warning(png_structp, png_const_charp) {}

void on_write(png_structp png, png_bytep bytes, std::size_t count)
{
    auto& write = *static_cast<PngWrite*>(png_get_io_ptr(png));
    write.why = write.sink.write({reinterpret_cast<const std::byte*>(bytes), count});
    if (!write.why.ok())
        std::longjmp(write.escape, 1);
}

void on_flush(png_structp) {}

void run(PngWrite& write)
{
    if (setjmp(write.escape) != 0)
        return;
    write.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &write, &on_error, &on_warning);
    write.info = write.png == nullptr ? nullptr : png_create_info_struct(write.png);
    if (write.info == nullptr)
        leave(write,
              failure(Fault::kOsError, "%s: no memory for encoding; end other programs", shown_path(write.name)));
    png_set_write_fn(write.png, &write, &on_write, &on_flush);
    const Rows& rows = write.rows;
    png_set_IHDR(write.png, write.info, static_cast<png_uint_32>(rows.width), static_cast<png_uint_32>(rows.height),
                 rows.bits, rows.colour_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(write.png, write.info);
    if (rows.bits == 16 && std::endian::native == std::endian::little)
        png_set_swap(write.png);
    for (int y = 0; y < rows.height; ++y)
        png_write_row(write.png, rows.first + y * rows.stride_bytes);
    png_write_end(write.png, write.info);
}

Status write_rows(ByteSink& sink, const char* name, const Rows& rows) noexcept
{
    TRY(check_writable_size(name, rows.width, rows.height));
    PngWrite write{.sink = sink, .name = name, .rows = rows, .png = nullptr, .info = nullptr, .why = {}, .escape = {}};
    run(write);
    png_destroy_write_struct(&write.png, &write.info);
    return write.why;
}

Status write_file(const char* path, const Rows& rows) noexcept
{
    TRY(check_writable_size(path, rows.width, rows.height));
    OutputFile file;
    TRY(file.open(path));
    TRY(write_rows(file, path, rows));
    return file.commit();
}

Rows rows_of(ImageView<const Rgb8> picture)
{
    return {reinterpret_cast<const std::uint8_t*>(picture.data),
            picture.stride * static_cast<std::ptrdiff_t>(sizeof(Rgb8)),
            picture.width,
            picture.height,
            8,
            PNG_COLOR_TYPE_RGB};
}

} // namespace

Status write_png(const char* path, ImageView<const Rgb8> picture) noexcept
{
    return write_file(path, rows_of(picture));
}

Status write_png(ByteSink& sink, const char* name, ImageView<const Rgb8> picture) noexcept
{
    return write_rows(sink, name, rows_of(picture));
}

Status write_png16(const char* path, ImageView<const std::uint16_t> picture) noexcept
{
    return write_file(path, {reinterpret_cast<const std::uint8_t*>(picture.data),
                             picture.stride * static_cast<std::ptrdiff_t>(sizeof(std::uint16_t)), picture.width,
                             picture.height, 16, PNG_COLOR_TYPE_GRAY});
}

} // namespace dicot
