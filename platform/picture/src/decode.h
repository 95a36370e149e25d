// What the decoders of the picture formats have in common.
#pragma once

#include "byte_source.h"
#include "dicot/picture/jpeg_luma.h"
#include "dicot/picture/read_picture.h"

#include <cstdint>

namespace dicot {

/// What a decoder is asked for: the size alone, or the pixels too.
struct PictureRequest
{
    const ImageView<Rgb8>* into = nullptr; ///< null: the size alone
    PictureSize size{};                    ///< the answer
    const LumaRowSink* luma = nullptr;     ///< of a JPEG: block luma instead of pixels
};

/// Notes the size that the header tells. Fails above the limits, and where `into` has another size. Decoders call it
/// before anything is allocated by that size.
Status accept_size(const char* name, std::uint64_t width, std::uint64_t height, PictureRequest& request) noexcept;

/// The file ended too early: because reading failed, or because it is cut short.
Status ended_early(const ByteSource& source) noexcept;
Status damaged(const char* name, const char* detail) noexcept;

/// Each reads from the first byte of the file; the caller has seen the format's magic.
Status decode_png(ByteSource& source, PictureRequest& request) noexcept;
Status decode_jpeg(ByteSource& source, PictureRequest& request) noexcept;
Status decode_pnm(ByteSource& source, PictureRequest& request) noexcept;

} // namespace dicot
