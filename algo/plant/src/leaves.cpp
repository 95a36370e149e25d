#include "dicot/plant/leaves.h"

#include "basins.h"
#include "dicot/plant/canopy.h"
#include "merge.h"
#include "stems.h"
#include "surface.h"
#include "tails.h"

#include <algorithm>
#include <array>

namespace dicot {
namespace {

constexpr int kLeastPoints = 120; ///< of a leaf
constexpr int kLeastShare = 50;   ///< of the points of the plant's largest leaf, one in so many: smaller are crumbs

/// A piece of the surface, before it has a leaf's number.
struct Blade
{
    std::int32_t points = 0;
    std::int64_t columns = 0; ///< their sum
    std::uint8_t plant = 0;
    std::uint16_t leaf = Leaves::kNone;

    double column() const { return static_cast<double>(columns) / points; }
};

void count_blades(const Surface& surface, const Pieces& pieces, std::span<Blade> blades)
{
    std::ranges::fill(blades, Blade{});
    for (std::size_t i = 0; i < surface.cells(); ++i) {
        if (surface.cell[i] != Surface::kPoint || pieces.piece[i] == 0)
            continue;
        Blade& blade = blades[static_cast<std::size_t>(pieces.piece[i]) - 1];
        ++blade.points;
        blade.columns += static_cast<std::int64_t>(i % static_cast<std::size_t>(surface.width));
        blade.plant = surface.plant[i];
    }
}

/// What is too small to be a leaf loses its points.
void drop_crumbs(std::span<Blade> blades)
{
    std::array<std::int32_t, UINT8_MAX + 1> largest{};
    for (const Blade& blade : blades)
        largest[blade.plant] = std::max(largest[blade.plant], blade.points);
    for (Blade& blade : blades)
        if (blade.points < std::max(kLeastPoints, largest[blade.plant] / kLeastShare))
            blade.points = 0;
}

/// Plant by plant, from left to right.
void number_leaves(std::span<Blade> blades, Leaves& leaves)
{
    const auto before = [](const Blade& a, const Blade& b) {
        return a.plant != b.plant ? a.plant < b.plant : a.column() < b.column();
    };
    for (;;) {
        Blade* next = nullptr;
        for (Blade& blade : blades)
            if (blade.points > 0 && blade.leaf == Leaves::kNone && (next == nullptr || before(blade, *next)))
                next = &blade;
        if (next == nullptr)
            break;
        leaves.plant_of_leaf[static_cast<std::size_t>(leaves.leaf_count)] = next->plant;
        next->leaf = static_cast<std::uint16_t>(++leaves.leaf_count);
    }
    leaves.plant_of_leaf = leaves.plant_of_leaf.first(static_cast<std::size_t>(leaves.leaf_count));
}

} // namespace

std::size_t segment_leaves_bytes(const PlantView& view)
{
    // Lists of the points, layers of the cells, and what is of one size for any cloud.
    constexpr std::size_t kPointBytes = 32, kCellBytes = 22, kAnyBytes = std::size_t{8} << 20;
    constexpr int kFrame = 2 * Surface::kMargin;
    const std::size_t cells =
        (static_cast<std::size_t>(view.point.width) + kFrame) * (static_cast<std::size_t>(view.point.height) + kFrame);
    return kPointBytes * view.cloud.points.size() + kCellBytes * cells + kAnyBytes;
}

Result<Leaves> segment_leaves(const PlantView& view, std::span<const PlantBox> boxes, Arena& arena)
{
    const auto too_little = [] { return failure(Fault::kConfig, "too little memory to look for leaves"); };
    Leaves leaves;
    leaves.leaf = arena.take<std::uint16_t>(view.cloud.points.size());
    leaves.plant_of_leaf = arena.take<std::uint8_t>(kMostPieces);
    leaves.ground = find_ground(view, arena);
    Canopy canopy = find_canopy(view, leaves.ground, arena, !boxes.empty());
    stand_on_soil(view, canopy, leaves.ground, arena);
    if (arena.overrun())
        return too_little();
    if (!boxes.empty())
        put_in_boxes(view, leaves.ground, boxes, canopy);
    leaves.plant = canopy.plant;
    leaves.plant_count = canopy.plant_count;
    std::ranges::fill(leaves.leaf, Leaves::kNone);

    const std::size_t mark = arena.used();
    const Surface surface = surface_of(view, canopy, arena);
    Pieces pieces = cut_at_necks(surface, arena);
    merge_pieces(surface, pieces, arena);
    cut_tails(surface, pieces, arena);
    drop_stems(view, surface, pieces, arena);
    const std::span<Blade> blades = arena.take<Blade>(static_cast<std::size_t>(pieces.count));
    if (arena.overrun())
        return too_little();
    count_blades(surface, pieces, blades);
    drop_crumbs(blades);
    number_leaves(blades, leaves);
    for (std::size_t i = 0; i < surface.cells(); ++i)
        if (surface.cell[i] == Surface::kPoint && pieces.piece[i] != 0)
            leaves.leaf[static_cast<std::size_t>(surface.point(view, i))] =
                blades[static_cast<std::size_t>(pieces.piece[i]) - 1].leaf;
    arena.rewind(mark);
    return leaves;
}

} // namespace dicot
