#include "basins.h"

#include "groups.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dicot {
namespace {

/// Cells of the surface, the deepest first, else in the order of the picture.
std::span<std::int32_t> deepest_first(const Surface& surface, Arena& arena)
{
    const int deepest = *std::ranges::max_element(surface.inside_px5);
    const std::span<std::int32_t> starts = arena.take<std::int32_t>(static_cast<std::size_t>(deepest) + 2);
    const std::span<std::int32_t> order = arena.take<std::int32_t>(surface.cells());
    if (arena.overrun())
        return {};
    std::ranges::fill(starts, 0);
    const auto bucket = [&](std::size_t i) { return static_cast<std::size_t>(deepest - surface.inside_px5[i]); };
    for (std::size_t i = 0; i < surface.cells(); ++i)
        ++starts[bucket(i) + 1];
    for (std::size_t k = 1; k < starts.size(); ++k)
        starts[k] += starts[k - 1];
    const auto outside = static_cast<std::size_t>(starts[static_cast<std::size_t>(deepest)]);
    for (std::size_t i = 0; i < surface.cells(); ++i)
        order[static_cast<std::size_t>(starts[bucket(i)]++)] = static_cast<std::int32_t>(i);
    return order.first(outside);
}

} // namespace

Pieces cut_at_necks(const Surface& surface, Arena& arena)
{
    constexpr int kNeckNumerator = 6, kNeckDenominator = 10;
    Pieces pieces;
    pieces.piece = arena.take<std::int32_t>(surface.cells());
    const std::size_t mark = arena.used();
    const std::span<std::int32_t> parent = arena.take<std::int32_t>(surface.cells());
    if (arena.overrun() || surface.cells() == 0)
        return pieces;
    const std::span<const std::int32_t> order = deepest_first(surface, arena);
    if (arena.overrun())
        return pieces;

    // A basin is named by its peak's cell.
    constexpr std::int32_t kDry = -1;
    std::ranges::fill(pieces.piece, kDry);
    Groups basins(parent);
    const auto below = static_cast<std::size_t>(surface.width);
    const auto inside = [&](std::int32_t i) { return int{surface.inside_px5[static_cast<std::size_t>(i)]}; };
    for (const std::int32_t here : order) {
        const auto i = static_cast<std::size_t>(here);
        std::array<std::int32_t, 4> near{};
        std::size_t count = 0;
        const auto meet = [&](std::uint8_t side, std::size_t j) {
            if ((surface.torn[i] & side) != 0 || pieces.piece[j] == kDry)
                return;
            const std::int32_t basin = basins.root(pieces.piece[j]);
            if (std::find(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), basin) ==
                near.begin() + static_cast<std::ptrdiff_t>(count))
                near[count++] = basin;
        };
        meet(Surface::kRight, i + 1);
        meet(Surface::kBelow, i + below);
        meet(Surface::kLeft, i - 1);
        meet(Surface::kAbove, i - below);
        if (count == 0) {
            pieces.piece[i] = here;
            continue;
        }
        std::int32_t home = near[0];
        for (std::size_t k = 1; k < count; ++k)
            if (inside(near[k]) > inside(home) || (inside(near[k]) == inside(home) && near[k] < home))
                home = near[k];
        pieces.piece[i] = home;
        for (std::size_t k = 0; k < count; ++k)
            if (near[k] != home && kNeckDenominator * (inside(here) + 2) >= kNeckNumerator * inside(near[k]))
                basins.hang(near[k], home);
    }

    // Roots become numbers, in the order of the picture.
    std::span<std::int32_t> number = parent;
    for (std::size_t i = 0; i < surface.cells(); ++i)
        if (pieces.piece[i] != kDry)
            pieces.piece[i] = basins.root(pieces.piece[i]);
    std::ranges::fill(number, 0);
    for (std::size_t i = 0; i < surface.cells(); ++i) {
        if (pieces.piece[i] == kDry) {
            pieces.piece[i] = 0;
            continue;
        }
        std::int32_t& named = number[static_cast<std::size_t>(pieces.piece[i])];
        if (named == 0)
            named = ++pieces.count;
        pieces.piece[i] = named;
    }
    arena.rewind(mark);
    return pieces;
}

} // namespace dicot
