// Reading PNG, JPEG and PPM/PGM files into memory that the caller carved.
#pragma once

#include "dicot/base/image.h"
#include "dicot/base/status.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

inline constexpr int kMaxPictureSide = 16384;                                     ///< px
inline constexpr std::int64_t kMaxPicturePixels = std::int64_t{64} * 1024 * 1024; ///< px

struct PictureSize
{
    int width = 0;
    int height = 0;
    std::int64_t pixels() const { return std::int64_t{width} * height; }
};

/// Width and height from the file's header, within the limits above; nothing behind the header is looked at.
///
/// The format is decided by the content, never by the name. Fault::kNoInput: missing, unreadable, a folder.
/// Fault::kBadData: empty, not a picture, cut short, too large.
Result<PictureSize> picture_size(const char* path) noexcept;

/// Decodes a whole picture into `into`, which has exactly the size that picture_size() told.
///
/// - PNG: 8 and 16 bits, grey, palette, colour, interlaced. Transparency is composed on black; gamma and profiles are
///   ignored: the numbers in the file are the pixels.
/// - JPEG: grey and colour, baseline and progressive. Orientation is ignored: rows come as the sensor wrote them.
///   CMYK is refused. The same file gives the same pixels on every CPU.
/// - PPM, PGM: P2, P3, P5, P6, largest value 1 .. 65535. Of several pictures in one file the first is read.
/// - Values wider than 8 bits are rounded: v * 255 / largest. Grey becomes r = g = b.
///
/// A file that is cut short or damaged anywhere up to its end marker is refused; bytes behind the end marker are
/// ignored. After a failure `into` is unspecified. Faults as for picture_size(); kIoError when reading fails half-way.
/// The decoders take working memory from malloc: a few rows, and up to 64 MiB for the coefficients of a progressive
/// JPEG, beyond which it is refused.
Status read_picture(const char* path, ImageView<Rgb8> into) noexcept;

/// The same from memory. `name` stands for the file in sentences.
Result<PictureSize> picture_size_bytes(std::span<const std::byte> file, const char* name) noexcept;
Status read_picture_bytes(std::span<const std::byte> file, const char* name, ImageView<Rgb8> into) noexcept;

} // namespace dicot
