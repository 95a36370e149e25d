// Reading disparity maps, ours and those of the benchmarks, into memory that the caller carved.
#pragma once

#include "dicot/base/image.h"
#include "dicot/base/status.h"
#include "dicot/picture/read_picture.h"

#include <cstddef>
#include <span>

namespace dicot {

enum class MapKind
{
    kPfm,   ///< float32, disparities in px
    kPng8,  ///< grey, 8 bits
    kPng16, ///< grey, 16 bits
};

struct MapHead
{
    PictureSize size;
    MapKind kind = MapKind::kPfm;
};

/// Size and kind from the file's header, within the limits of read_picture.h; the content decides, not the name.
///
/// Fault::kNoInput: missing, unreadable, a folder. Fault::kBadData: empty, cut short, too large, neither a PFM of one
/// channel nor a grey PNG of 8 or 16 bits.
Result<MapHead> map_head(const char* path) noexcept;

/// Reads a whole map into `into`, which has the size that map_head() told: disparities in px, rows from the top,
/// +infinity where there is none.
///
/// - PFM ("Pf"): either byte order, told by the sign of the scale, whose size is ignored as the benchmarks do.
/// +infinity
///   is missing; NaN and -infinity are refused.
/// - PNG: value / png_scale, 0 is missing; png_scale > 0.
///
/// After a failure `into` is unspecified. Faults as for map_head(); kIoError when reading fails half-way.
Status read_map(const char* path, double png_scale, ImageView<float> into) noexcept;

/// The same from memory. `name` stands for the file in sentences.
Result<MapHead> map_head_bytes(std::span<const std::byte> file, const char* name) noexcept;
Status read_map_bytes(std::span<const std::byte> file, const char* name, double png_scale,
                      ImageView<float> into) noexcept;

} // namespace dicot
