// Colour pictures as detection wants them.
#pragma once

#include "dicot/base/image.h"

#include <cstdint>

namespace dicot::calibration {

/// Luma of BT.601, rounded: (77 r + 150 g + 29 b + 128) / 256. Both pictures have one size.
void to_grey(ImageView<const Rgb8> colour, ImageView<std::uint8_t> grey);

} // namespace dicot::calibration
