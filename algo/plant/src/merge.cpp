#include "merge.h"

#include "quadric.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace dicot {
namespace {

/// The odds that two pieces in contact are one blade:
///
///     neck * near * sqrt(length * (roughness + 1/2)) / (misfit + 1/2)^2
///
/// neck: half width of the widest contact by that of the narrower piece; near: pairs of cells not more than kReachPx
/// apart by the points of the smaller piece; length: of the contact, by the side of a square as large as the smaller
/// piece; misfit and roughness (quadric.h) in widths of a pixel. The form follows a logistic regression on the rendered
/// plants, species left out in turn; its exponents are rounded, so that no logarithm is needed.
constexpr double kLeastOdds = 0.22;
/// Of the two halves of a fold.
constexpr double kSureOdds = 0.25;
/// Without contact (a petiole in front, a hole) more has to agree.
constexpr double kMostGapMisfitPx = 2.6;
constexpr int kLeastNear = 200;
constexpr int kReachPx = 24;
constexpr int kLeastPoints = 40;

struct Piece
{
    QuadricSums shape;
    double half_width_px = 0;
    bool gone = false;
};

/// What stands between two pieces.
struct Border
{
    std::int32_t near = 0;   ///< pairs of cells
    std::int32_t widest = 0; ///< of the contact, in fifths of a px; 0: none
    std::int32_t length = 0; ///< of the contact, pairs of cells
    std::int32_t torn = 0;   ///< pairs of cells with a tear between them
    float odds = 0;
};

/// Two halves of a blade folded at its midrib hang together all along it, which no one surface of second degree fits;
/// of two blades that overlap, most of what they have in common is a tear.
bool is_fold(const Border& between, double points)
{
    constexpr double kUntorn = 0.75, kLeastLength = 1.2; // of the side of a square as large as the smaller piece
    return between.length > kUntorn * (between.length + between.torn) &&
           between.length > kLeastLength * std::sqrt(points);
}

class Merger
{
public:
    Merger(std::span<Piece> pieces, std::span<Border> borders) : pieces_(pieces), borders_(borders) {}

    Piece& piece(std::size_t i) { return pieces_[i]; }
    Border& border(std::size_t i, std::size_t j) { return borders_[std::max(i, j) * pieces_.size() + std::min(i, j)]; }

    void weigh(std::size_t i, std::size_t j)
    {
        Border& between = border(i, j);
        if (between.near == 0)
            return;
        const Piece &a = pieces_[i], &b = pieces_[j];
        const double off = misfit(a.shape, b.shape);
        if (is_fold(between, std::min(a.shape.count(), b.shape.count()))) {
            between.odds = static_cast<float>(kSureOdds);
            return;
        }
        if (between.widest == 0) {
            // After all contacts, the smoothest first.
            const bool one = off < kMostGapMisfitPx && between.near > kLeastNear;
            between.odds = static_cast<float>(one ? kLeastOdds * (1 + 1e-3 / (off + 0.1)) : 0);
            return;
        }
        constexpr double kSlackPx = 0.6;
        const double neck =
            (double(between.widest) / Surface::kUnit + kSlackPx) / std::min(a.half_width_px, b.half_width_px);
        const double points = std::min(a.shape.count(), b.shape.count());
        const double long_and_rough = between.length / std::sqrt(points) * (own_roughness(a.shape, b.shape) + 0.5);
        between.odds =
            static_cast<float>(neck * between.near / points * std::sqrt(long_and_rough) / ((off + 0.5) * (off + 0.5)));
    }

    void weigh_all()
    {
        for (std::size_t i = 0; i < pieces_.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                weigh(i, j);
    }

    /// The pair with the best odds, if they are good enough: i > j.
    bool best(std::size_t& i, std::size_t& j) const
    {
        float most = static_cast<float>(kLeastOdds);
        bool found = false;
        for (std::size_t k = 0; k < pieces_.size(); ++k)
            for (std::size_t l = 0; l < k; ++l)
                if (!pieces_[k].gone && !pieces_[l].gone && borders_[k * pieces_.size() + l].odds > most) {
                    most = borders_[k * pieces_.size() + l].odds;
                    i = k;
                    j = l;
                    found = true;
                }
        return found;
    }

    /// Piece i becomes part of j.
    void join(std::size_t i, std::size_t j)
    {
        pieces_[i].gone = true;
        pieces_[j].shape.add(pieces_[i].shape);
        pieces_[j].half_width_px = std::max(pieces_[j].half_width_px, pieces_[i].half_width_px);
        for (std::size_t k = 0; k < pieces_.size(); ++k) {
            if (k == i || k == j || pieces_[k].gone)
                continue;
            const Border from = border(i, k);
            Border& to = border(j, k);
            to.near += from.near;
            to.widest = std::max(to.widest, from.widest);
            to.length += from.length;
            to.torn += from.torn;
            weigh(j, k);
        }
    }

private:
    std::span<Piece> pieces_;
    std::span<Border> borders_;
};

/// Numbers the pieces of enough points 1 .. n in the order that they had; the others become 0.
int drop_small(const Surface& surface, Pieces& pieces, std::span<std::int32_t> size)
{
    std::ranges::fill(size, 0);
    for (std::size_t i = 0; i < surface.cells(); ++i)
        if (surface.cell[i] == Surface::kPoint)
            ++size[static_cast<std::size_t>(pieces.piece[i])];
    size[0] = 0;
    int least = kLeastPoints;
    while (std::ranges::count_if(size, [&](std::int32_t s) { return s >= least; }) > kMostPieces)
        least *= 2;
    int count = 0;
    for (std::int32_t& s : size)
        s = s >= least ? ++count : 0;
    for (std::int32_t& piece : pieces.piece)
        piece = size[static_cast<std::size_t>(piece)];
    return count;
}

void sum_shapes(const Surface& surface, const Pieces& pieces, std::span<Piece> all)
{
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < surface.cells(); ++i)
        if (surface.cell[i] == Surface::kPoint) {
            sum += double{surface.inverse[i]};
            ++count;
        }
    const double middle = count > 0 ? sum / count : 1;
    constexpr double kUnitPx = 100;
    const auto width = static_cast<std::size_t>(surface.width);
    for (std::size_t i = 0; i < surface.cells(); ++i) {
        if (pieces.piece[i] == 0)
            continue;
        Piece& piece = all[static_cast<std::size_t>(pieces.piece[i]) - 1];
        piece.half_width_px = std::max(piece.half_width_px, double(surface.inside_px5[i]) / Surface::kUnit);
        const std::size_t column = i % width, row = i / width;
        if (surface.cell[i] == Surface::kPoint)
            piece.shape.add((double(column) - surface.width / 2.0) / kUnitPx,
                            (double(row) - surface.height / 2.0) / kUnitPx,
                            (double{surface.inverse[i]} / middle - 1) * surface.focal_px);
    }
}

void find_borders(const Surface& surface, const Pieces& pieces, Merger& merger)
{
    constexpr int kWays[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    for (int y = 0; y < surface.height; ++y)
        for (int x = 0; x < surface.width; ++x) {
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(surface.width) + static_cast<std::size_t>(x);
            const std::int32_t here = pieces.piece[i];
            if (here == 0)
                continue;
            for (const auto& [dx, dy] : kWays)
                for (int k = 1; k <= kReachPx; ++k) {
                    const int u = x + k * dx, v = y + k * dy;
                    if (u < 0 || u >= surface.width || v >= surface.height)
                        break;
                    const std::size_t j = i + static_cast<std::size_t>(k * (dy * surface.width + dx));
                    const std::int32_t there = pieces.piece[j];
                    if (there == 0 || there == here || surface.plant[i] != surface.plant[j])
                        continue;
                    Border& between =
                        merger.border(static_cast<std::size_t>(here) - 1, static_cast<std::size_t>(there) - 1);
                    ++between.near;
                    if (k != 1 || (dx != 0 && dy != 0))
                        continue;
                    if ((surface.torn[i] & (dx == 1 ? Surface::kRight : Surface::kBelow)) != 0)
                        ++between.torn;
                    else {
                        between.widest = std::max<std::int32_t>(between.widest,
                                                                std::min(surface.inside_px5[i], surface.inside_px5[j]));
                        ++between.length;
                    }
                }
        }
}

} // namespace

void merge_pieces(const Surface& surface, Pieces& pieces, Arena& arena)
{
    const std::size_t mark = arena.used();
    const std::span<std::int32_t> name = arena.take<std::int32_t>(static_cast<std::size_t>(pieces.count) + 1);
    if (arena.overrun())
        return;
    const auto count = static_cast<std::size_t>(drop_small(surface, pieces, name));
    const std::span<Piece> all = arena.take<Piece>(count);
    const std::span<Border> borders = arena.take<Border>(count * count);
    if (arena.overrun())
        return;
    std::ranges::fill(all, Piece{});
    std::ranges::fill(borders, Border{});
    Merger merger(all, borders);
    sum_shapes(surface, pieces, all);
    find_borders(surface, pieces, merger);
    merger.weigh_all();

    for (std::size_t i = 0; i < count; ++i)
        name[i] = static_cast<std::int32_t>(i);
    for (std::size_t i = 0, j = 0; merger.best(i, j);) {
        merger.join(i, j);
        for (std::size_t k = 0; k < count; ++k)
            if (name[k] == static_cast<std::int32_t>(i))
                name[k] = static_cast<std::int32_t>(j);
    }
    for (std::int32_t& piece : pieces.piece)
        if (piece != 0)
            piece = name[static_cast<std::size_t>(piece) - 1] + 1;
    pieces.count = static_cast<int>(count);
    arena.rewind(mark);
}

} // namespace dicot
