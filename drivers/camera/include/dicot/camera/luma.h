// How bright a frame is, cheaply: for the warm-up and for exposure.
#pragma once

#include "dicot/base/image.h"
#include "dicot/base/status.h"
#include "dicot/camera/frame.h"

#include <cstdint>

namespace dicot {

struct LumaFigures
{
    std::uint32_t mean_q8 = 0;       ///< mean luma of the decoded picture, 0 .. 255, in 1/256
    std::uint32_t saturated_q16 = 0; ///< share of samples at kSaturatedLuma and above, in 1/65536
    std::uint32_t samples = 0;       ///< how many were looked at
};

/// Luma of a decoded pixel, 0 .. 255, full range.
constexpr std::uint8_t luma_of(Rgb8 pixel) noexcept
{
    return static_cast<std::uint8_t>((77U * pixel.r + 150U * pixel.g + 29U * pixel.b + 128U) / 256U);
}

constexpr int kSaturatedLuma = 250; ///< of the decoded picture, 0 .. 255

/// Looks at every 4th pixel of every 4th row (raw formats) or at the means of all 8 x 8 blocks (MJPEG, where a small
/// highlight in a dark block does not count as saturated). Full range whatever the format: Y of YUYV and NV12 is
/// spread as decode_frame() does. Integers only. Faults as for decode_frame().
Result<LumaFigures> luma_of(const Frame& frame) noexcept;

/// The same of a decoded picture.
LumaFigures luma_of(ImageView<const Rgb8> picture) noexcept;

} // namespace dicot
