#include "levels.h"

namespace dicot::aiming {
namespace {

void halve(Grey from, ImageView<std::uint8_t> to)
{
    for (int y = 0; y < to.height; ++y) {
        const std::uint8_t* const upper = from.row(2 * y);
        const std::uint8_t* const lower = from.row(2 * y + 1);
        std::uint8_t* const out = to.row(y);
        for (int x = 0; x < to.width; ++x)
            out[x] =
                static_cast<std::uint8_t>((upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1] + 2) / 4);
    }
}

} // namespace

Levels make_levels(Grey picture, Arena& arena)
{
    Levels levels;
    levels.level[0] = picture;
    levels.count = 1;
    while ((levels.smallest().width >= Levels::kNarrowerThan || levels.smallest().height >= Levels::kLowerThan) &&
           levels.count < Levels::kMost) {
        const Grey from = levels.smallest();
        const int width = from.width / 2, height = from.height / 2;
        const auto pixels =
            arena.take<std::uint8_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        const ImageView<std::uint8_t> half{pixels.data(), width, height};
        if (from.data != nullptr && !pixels.empty())
            halve(from, half);
        levels.level[static_cast<std::size_t>(levels.count++)] = half;
    }
    return levels;
}

} // namespace dicot::aiming
