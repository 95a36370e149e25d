#include "decode.h"
#include "dicot/os/shown_path.h"

#include <algorithm>
#include <csetjmp>
#include <cstdio> // jpeglib.h needs FILE

#include <jpeglib.h>

#include <jerror.h>

namespace dicot {
namespace {

/// A progressive picture keeps all its coefficients while it is decoded: 6 bytes a pixel at the most.
constexpr long kMaxDecoderMiB = 64;
/// Each scan costs a walk over the whole picture; real files have about ten.
constexpr int kMaxScans = 100;

/// All that lives across libjpeg's jumps out of an error; the jumps cross no frame with a destructor to run.
struct JpegRead
{
    ByteSource& source;
    PictureRequest& request;
    jpeg_decompress_struct jpeg;
    jpeg_error_mgr errors;
    jpeg_source_mgr input;
    jpeg_progress_mgr progress;
    Status why;
    std::jmp_buf escape;
};

JpegRead& reader_of(j_common_ptr jpeg) noexcept
{
    return *static_cast<JpegRead*>(jpeg->client_data);
}
JpegRead& reader_of(j_decompress_ptr jpeg) noexcept
{
    return *static_cast<JpegRead*>(jpeg->client_data);
}

[[noreturn]] void leave(JpegRead& read, const Status& why) noexcept
{
    read.why = why;
    std::longjmp(read.escape, 1);
}

[[noreturn]] void leave_with_its_message(j_common_ptr jpeg)
{
    char detail[JMSG_LENGTH_MAX];
    jpeg->err->format_message(jpeg, detail);
    JpegRead& read = reader_of(jpeg);
    leave(read, damaged(read.source.name(), detail));
}

[[noreturn]] void on_error(j_common_ptr jpeg)
{
    JpegRead& read = reader_of(jpeg);
    const char* shown = shown_path(read.source.name());
    switch (jpeg->err->msg_code) {
    case JERR_IMAGE_TOO_BIG: {
        const Status why = accept_size(read.source.name(), read.jpeg.image_width, read.jpeg.image_height, read.request);
        if (!why.ok())
            leave(read, why);
        break;
    }
    case JERR_NO_BACKING_STORE:
    case JERR_OUT_OF_MEMORY:
        leave(read, failure(Fault::kBadData,
                            "%s: decoding this JPEG takes more than %ld MiB; save it as baseline JPEG or PNG", shown,
                            kMaxDecoderMiB));
    default:
        break;
    }
    leave_with_its_message(jpeg);
}

/// libjpeg goes on after a warning and invents the missing pixels; dicot does not.
void on_message(j_common_ptr jpeg, int level)
{
    if (level >= 0)
        return;
    switch (jpeg->err->msg_code) {
    case JWRN_EXTRANEOUS_DATA: // cameras pad with zeros in front of the end marker
    case JWRN_ADOBE_XFORM:
    case JWRN_BOGUS_ICC:
    case JWRN_JFIF_MAJOR:
    case JWRN_NOT_SEQUENTIAL:
        return;
    default:
        leave_with_its_message(jpeg);
    }
}

void on_init(j_decompress_ptr) {}
void on_term(j_decompress_ptr) {}

boolean on_fill(j_decompress_ptr jpeg)
{
    JpegRead& read = reader_of(jpeg);
    const std::span<const std::byte> ahead = read.source.ahead();
    if (ahead.empty())
        leave(read, ended_early(read.source));
    // Given out as a whole; nobody else reads the source meanwhile.
    read.input.next_input_byte = reinterpret_cast<const JOCTET*>(ahead.data());
    read.input.bytes_in_buffer = ahead.size();
    read.source.pass(ahead.size());
    return TRUE;
}

void on_skip(j_decompress_ptr jpeg, long count)
{
    jpeg_source_mgr& input = reader_of(jpeg).input;
    auto left = static_cast<std::size_t>(std::max(0L, count));
    while (left > input.bytes_in_buffer) {
        left -= input.bytes_in_buffer;
        on_fill(jpeg);
    }
    input.next_input_byte += left;
    input.bytes_in_buffer -= left;
}

void on_progress(j_common_ptr jpeg)
{
    JpegRead& read = reader_of(jpeg);
    if (read.jpeg.input_scan_number > kMaxScans)
        leave(read, failure(Fault::kBadData, "%s: the JPEG has more than %d scans; save it as baseline JPEG or PNG",
                            shown_path(read.source.name()), kMaxScans));
}

void read_pixels(JpegRead& read)
{
    jpeg_decompress_struct& jpeg = read.jpeg;
    // Exact integer arithmetic, whose vector code gives the same bits.
    jpeg.dct_method = JDCT_ISLOW;
    jpeg.do_fancy_upsampling = TRUE;
    jpeg.do_block_smoothing = FALSE;
    jpeg.out_color_space = JCS_RGB;
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
        auto* row = reinterpret_cast<JSAMPROW>(read.request.into->row(static_cast<int>(jpeg.output_scanline)));
        jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
}

void read_luma(JpegRead& read)
{
    jpeg_decompress_struct& jpeg = read.jpeg;
    jpeg.dct_method = JDCT_ISLOW;
    jpeg.do_block_smoothing = FALSE;
    jpeg.out_color_space = JCS_GRAYSCALE;
    jpeg.scale_num = 1;
    jpeg.scale_denom = 8;
    jpeg_start_decompress(&jpeg);
    JSAMPLE blocks[(kMaxPictureSide + 7) / 8];
    if (jpeg.output_width > sizeof blocks)
        leave(read, damaged(read.source.name(), "it is wider than it says"));
    while (jpeg.output_scanline < jpeg.output_height) {
        JSAMPROW row = blocks;
        jpeg_read_scanlines(&jpeg, &row, 1);
        read.request.luma->take(read.request.luma->object, {blocks, jpeg.output_width});
    }
    jpeg_finish_decompress(&jpeg);
}

void run(JpegRead& read)
{
    if (setjmp(read.escape) != 0)
        return;
    jpeg_decompress_struct& jpeg = read.jpeg;
    jpeg.err = jpeg_std_error(&read.errors);
    read.errors.error_exit = &on_error;
    read.errors.emit_message = &on_message;
    jpeg.client_data = &read;
    jpeg_create_decompress(&jpeg);
    jpeg.mem->max_memory_to_use = kMaxDecoderMiB * 1024L * 1024L;
    read.progress.progress_monitor = &on_progress;
    jpeg.progress = &read.progress;
    read.input.init_source = &on_init;
    read.input.fill_input_buffer = &on_fill;
    read.input.skip_input_data = &on_skip;
    read.input.resync_to_restart = &jpeg_resync_to_restart;
    read.input.term_source = &on_term;
    jpeg.src = &read.input;

    jpeg_read_header(&jpeg, TRUE);
    const Status fits = accept_size(read.source.name(), jpeg.image_width, jpeg.image_height, read.request);
    if (!fits.ok())
        leave(read, fits);
    if (jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK)
        leave(read, failure(Fault::kBadData, "%s: is a CMYK JPEG, made for printing; convert it to RGB",
                            shown_path(read.source.name())));
    if (read.request.luma != nullptr)
        read_luma(read);
    else if (read.request.into != nullptr)
        read_pixels(read);
}

} // namespace

Status decode_jpeg(ByteSource& source, PictureRequest& request) noexcept
{
    JpegRead read{.source = source,
                  .request = request,
                  .jpeg = {},
                  .errors = {},
                  .input = {},
                  .progress = {},
                  .why = {},
                  .escape = {}};
    run(read);
    jpeg_destroy_decompress(&read.jpeg);
    return read.why;
}

} // namespace dicot
