#include "tails.h"

#include "groups.h"
#include "merge.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace dicot {
namespace {

/// A petiole begins two half widths behind where its blade has a quarter of its width left, and is as long again: a tip
/// ends before, even if its blade is sixteen times as long as wide.
constexpr int kCorePercent = 25, kReachPercent = 220, kLeastLengths = 2;
constexpr int kLeastPoints = 120;

/// Distances within each piece to its wide part, in fifths of a px.
void measure_from_core(const Surface& surface, const Pieces& pieces, std::span<const std::int32_t> half_width_px5,
                       std::span<std::int16_t> from_core)
{
    constexpr int kStraight = 5, kAcross = 7, kMostSweeps = 6;
    const auto below = static_cast<std::size_t>(surface.width);
    for (std::size_t i = 0; i < surface.cells(); ++i) {
        const std::int32_t piece = pieces.piece[i];
        const bool core =
            piece != 0 && 100 * surface.inside_px5[i] >= kCorePercent * half_width_px5[static_cast<std::size_t>(piece)];
        from_core[i] = core ? std::int16_t{0} : INT16_MAX;
    }
    bool nearer = true;
    const auto lower = [&](std::size_t i, std::size_t j, int way) {
        if (pieces.piece[i] == pieces.piece[j] && from_core[j] + way < from_core[i]) {
            from_core[i] = static_cast<std::int16_t>(from_core[j] + way);
            nearer = true;
        }
    };
    const std::size_t first = below + 1, last = surface.cells() - below - 1;
    for (int sweep = 0; sweep < kMostSweeps && nearer; ++sweep) {
        nearer = false;
        for (std::size_t i = first; i < last; ++i) {
            if (pieces.piece[i] == 0)
                continue;
            lower(i, i - 1, kStraight);
            lower(i, i - below, kStraight);
            lower(i, i - below - 1, kAcross);
            lower(i, i - below + 1, kAcross);
        }
        for (std::size_t i = last; i-- > first;) {
            if (pieces.piece[i] == 0)
                continue;
            lower(i, i + 1, kStraight);
            lower(i, i + below, kStraight);
            lower(i, i + below + 1, kAcross);
            lower(i, i + below - 1, kAcross);
        }
    }
}

} // namespace

void cut_tails(const Surface& surface, Pieces& pieces, Arena& arena)
{
    if (surface.cells() == 0)
        return;
    const std::size_t mark = arena.used();
    const std::span<std::int32_t> half_width = arena.take<std::int32_t>(static_cast<std::size_t>(pieces.count) + 1);
    const std::span<std::int16_t> from_core = arena.take<std::int16_t>(surface.cells());
    const std::span<std::int16_t> points = arena.take<std::int16_t>(surface.cells());
    const std::span<std::int32_t> parent = arena.take<std::int32_t>(surface.cells());
    if (arena.overrun())
        return;
    std::ranges::fill(half_width, 0);
    for (std::size_t i = 0; i < surface.cells(); ++i) {
        std::int32_t& widest = half_width[static_cast<std::size_t>(pieces.piece[i])];
        widest = std::max<std::int32_t>(widest, surface.inside_px5[i]);
    }
    measure_from_core(surface, pieces, half_width, from_core);

    // What lies beyond hangs together in tails; what no way leads to (behind a petiole in front) is none.
    const auto in_tail = [&](std::size_t i) {
        const auto piece = static_cast<std::size_t>(pieces.piece[i]);
        return piece != 0 && from_core[i] != INT16_MAX && 100 * from_core[i] > kReachPercent * half_width[piece];
    };
    Groups tails(parent);
    const auto below = static_cast<std::size_t>(surface.width);
    const auto hang = [&](std::size_t i, std::size_t j) {
        if (pieces.piece[i] == pieces.piece[j] && in_tail(j))
            tails.join(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
    };
    for (std::size_t i = below + 1; i + below + 1 < surface.cells(); ++i)
        if (in_tail(i)) {
            hang(i, i - 1);
            hang(i, i - below);
            hang(i, i - below - 1);
            hang(i, i - below + 1);
        }
    // A root comes before the rest of its tail: its cell holds the number, after those have been counted.
    for (std::size_t i = 0; i < surface.cells(); ++i)
        parent[i] = in_tail(i) ? tails.root(static_cast<std::int32_t>(i)) : -1;
    std::ranges::fill(points, std::int16_t{0});
    for (std::size_t i = 0; i < surface.cells(); ++i) {
        if (parent[i] < 0)
            continue;
        const auto root = static_cast<std::size_t>(parent[i]);
        from_core[root] = std::max(from_core[root], from_core[i]);
        if (surface.cell[i] == Surface::kPoint && points[root] < kLeastPoints)
            ++points[root];
    }
    for (std::size_t i = 0; i < surface.cells(); ++i) {
        if (parent[i] < 0)
            continue;
        const auto root = static_cast<std::size_t>(parent[i]);
        if (root != i)
            pieces.piece[i] = pieces.piece[root];
        else if (100 * from_core[i] >
                 kLeastLengths * kReachPercent * half_width[static_cast<std::size_t>(pieces.piece[i])])
            pieces.piece[i] = points[i] >= kLeastPoints && pieces.count < kMostPieces ? ++pieces.count : 0;
    }
    arena.rewind(mark);
}

} // namespace dicot
