// A picture as large as the pair, out of an arena.
#pragma once

#include "cost_rows.h"

#include "dicot/base/arena.h"
#include "dicot/base/image.h"

#include <cstddef>

namespace dicot::matching {

template <typename Pixel>
ImageView<Pixel> take_plane(Arena& arena, const Scene& scene)
{
    const auto pixels =
        arena.take<Pixel>(static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height));
    return {pixels.data(), scene.width, scene.height};
}

} // namespace dicot::matching
