#include "dicot/calibration/grey.h"

namespace dicot::calibration {

void to_grey(ImageView<const Rgb8> colour, ImageView<std::uint8_t> grey)
{
    for (int y = 0; y < colour.height; ++y) {
        const Rgb8* const from = colour.row(y);
        std::uint8_t* const to = grey.row(y);
        for (int x = 0; x < colour.width; ++x)
            to[x] = static_cast<std::uint8_t>((77 * from[x].r + 150 * from[x].g + 29 * from[x].b + 128) / 256);
    }
}

} // namespace dicot::calibration
