#include "aim_figures.h"

#include <algorithm>

namespace dicot::app {

Light light_of(ImageView<const Rgb8> colour, ImageView<const std::uint8_t> grey) noexcept
{
    const std::int64_t pixels = std::int64_t{grey.width} * grey.height;
    if (pixels <= 0)
        return {};
    std::int64_t sum = 0, saturated = 0;
    for (int y = 0; y < grey.height; ++y) {
        const Rgb8* const colours = colour.row(y);
        const std::uint8_t* const greys = grey.row(y);
        for (int x = 0; x < grey.width; ++x) {
            sum += greys[x];
            saturated += std::max({colours[x].r, colours[x].g, colours[x].b}) >= Light::kSaturated ? 1 : 0;
        }
    }
    return {static_cast<int>((sum + pixels / 2) / pixels),
            100.0 * static_cast<double>(saturated) / static_cast<double>(pixels)};
}

} // namespace dicot::app
