// How bright a JPEG is, for much less than decoding it.
#pragma once

#include "dicot/base/status.h"
#include "dicot/picture/read_picture.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// A borrowed callable `void(std::span<const std::uint8_t> row)`.
struct LumaRowSink
{
    void* object = nullptr;
    void (*take)(void* object, std::span<const std::uint8_t> row) = nullptr;
};

/// Gives the mean luma (0 .. 255, BT.601, full range) of each block of 8 x 8 pixels to `sink`, row after row of blocks;
/// blocks at the right and lower rim may lie partly outside. Only the DC coefficients are used. Returns the size in
/// pixels. The same bytes give the same figures on every CPU. Faults as for read_picture_bytes(); a file that is no
/// JPEG is Fault::kBadData. After a failure some rows may have been given.
Result<PictureSize> jpeg_luma(std::span<const std::byte> file, const char* name, LumaRowSink sink) noexcept;

} // namespace dicot
