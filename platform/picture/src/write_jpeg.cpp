#include "dicot/os/output_file.h"
#include "dicot/os/shown_path.h"
#include "dicot/picture/write_picture.h"
#include "writable.h"

#include <algorithm>
#include <csetjmp>
#include <cstdio> // jpeglib.h needs FILE

#include <jpeglib.h>

namespace dicot {
namespace {

/// All that lives across libjpeg's jumps out of an error; the jumps cross no frame with a destructor to run.
struct JpegWrite
{
    ByteSink& sink;
    const char* name;
    jpeg_compress_struct jpeg;
    jpeg_error_mgr errors;
    jpeg_destination_mgr output;
    Status why;
    std::jmp_buf escape;
    JOCTET buffer[4096];
};

JpegWrite& writer_of(j_compress_ptr jpeg) noexcept
{
    return *static_cast<JpegWrite*>(jpeg->client_data);
}

[[noreturn]] void on_error(j_common_ptr jpeg)
{
    auto& write = *static_cast<JpegWrite*>(jpeg->client_data);
    char detail[JMSG_LENGTH_MAX];
    jpeg->err->format_message(jpeg, detail);
    write.why = failure(Fault::kSoftware, "%s: libjpeg cannot write it (%s)", shown_path(write.name), detail);
    std::longjmp(write.escape, 1);
}

void on_message(j_common_ptr, int) {}

void on_init(j_compress_ptr jpeg)
{
    JpegWrite& write = writer_of(jpeg);
    write.output.next_output_byte = write.buffer;
    write.output.free_in_buffer = sizeof write.buffer;
}

void pass_on(JpegWrite& write, std::size_t count)
{
    write.why = write.sink.write({reinterpret_cast<const std::byte*>(write.buffer), count});
    if (!write.why.ok())
        std::longjmp(write.escape, 1);
}

/// The buffer is full, whatever free_in_buffer says: libjpeg's contract.
boolean on_full(j_compress_ptr jpeg)
{
    pass_on(writer_of(jpeg), sizeof JpegWrite::buffer);
    on_init(jpeg);
    return TRUE;
}

void on_term(j_compress_ptr jpeg)
{
    JpegWrite& write = writer_of(jpeg);
    pass_on(write, sizeof write.buffer - write.output.free_in_buffer);
}

void run(JpegWrite& write, const ImageView<const Rgb8>& picture, int quality)
{
    if (setjmp(write.escape) != 0)
        return;
    jpeg_compress_struct& jpeg = write.jpeg;
    jpeg.err = jpeg_std_error(&write.errors);
    write.errors.error_exit = &on_error;
    write.errors.emit_message = &on_message;
    jpeg.client_data = &write;
    jpeg_create_compress(&jpeg);
    write.output.init_destination = &on_init;
    write.output.empty_output_buffer = &on_full;
    write.output.term_destination = &on_term;
    jpeg.dest = &write.output;
    jpeg.image_width = static_cast<JDIMENSION>(picture.width);
    jpeg.image_height = static_cast<JDIMENSION>(picture.height);
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, std::clamp(quality, 1, 100), TRUE);
    jpeg.dct_method = JDCT_ISLOW;
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
        const Rgb8* const pixels = picture.row(static_cast<int>(jpeg.next_scanline));
        // libjpeg's rows are not const, and it does not write to them.
        auto* row = const_cast<JSAMPROW>(reinterpret_cast<const JSAMPLE*>(pixels));
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
}

} // namespace

Status write_jpeg(ByteSink& sink, const char* name, ImageView<const Rgb8> picture, int quality) noexcept
{
    TRY(check_writable_size(name, picture.width, picture.height));
    JpegWrite write{
        .sink = sink, .name = name, .jpeg = {}, .errors = {}, .output = {}, .why = {}, .escape = {}, .buffer = {}};
    run(write, picture, quality);
    jpeg_destroy_compress(&write.jpeg);
    return write.why;
}

Status write_jpeg(const char* path, ImageView<const Rgb8> picture, int quality) noexcept
{
    TRY(check_writable_size(path, picture.width, picture.height));
    OutputFile file;
    TRY(file.open(path));
    TRY(write_jpeg(file, path, picture, quality));
    return file.commit();
}

} // namespace dicot
