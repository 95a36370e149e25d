// A picture out of an arena.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/image.h"

#include <cstddef>

namespace dicot::app {

/// Rows without gaps; no pixels where the arena is too small (Arena::overrun()).
template <typename Pixel>
ImageView<Pixel> take_picture(Arena& arena, int width, int height)
{
    const auto pixels = arena.take<Pixel>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return {pixels.data(), width, height};
}

} // namespace dicot::app
