#include "speckles.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace dicot::matching {
namespace {

/// Columns of the right picture whose matches are not believed.
constexpr int kRim = 3;

constexpr int kLeastIsland = 40;  // px
constexpr int kSameSurface = 256; // 1/256 px

struct Position
{
    int x, y;
    bool operator==(const Position&) const = default;
};

bool hang_together(const Maps& maps, Position p, Position q)
{
    if (q.x < 0 || q.y < 0 || q.x >= maps.disparity.width || q.y >= maps.disparity.height)
        return false;
    return maps.verdict.row(p.y)[p.x] == Verdict::kMatched && maps.verdict.row(q.y)[q.x] == Verdict::kMatched &&
           std::abs(maps.disparity.row(p.y)[p.x] - maps.disparity.row(q.y)[q.x]) <= kSameSurface;
}

/// An island, as far as it matters how large it is.
struct Island
{
    std::array<Position, kLeastIsland> pixels;
    int size;
};

Island island_of(const Maps& maps, Position start)
{
    Island island{};
    const auto add = [&](Position p) {
        const auto end = island.pixels.begin() + island.size;
        if (island.size < kLeastIsland && std::find(island.pixels.begin(), end, p) == end)
            island.pixels[static_cast<std::size_t>(island.size++)] = p;
    };
    add(start);
    for (int i = 0; i < island.size && island.size < kLeastIsland; ++i) {
        const Position p = island.pixels[static_cast<std::size_t>(i)];
        for (const Position q : {Position{p.x - 1, p.y}, {p.x + 1, p.y}, {p.x, p.y - 1}, {p.x, p.y + 1}})
            if (hang_together(maps, p, q))
                add(q);
    }
    return island;
}

} // namespace

void drop_farther(const Maps& maps, int farther)
{
    const DispQ8 nearest = static_cast<DispQ8>(farther << kDispFractionBits);
    for (int y = 0; y < maps.disparity.height; ++y) {
        for (int x = 0; x < maps.disparity.width; ++x) {
            DispQ8& disparity = maps.disparity.row(y)[x];
            if (disparity == kDispMissing)
                continue;
            if (disparity >= nearest) {
                disparity = static_cast<DispQ8>(disparity - nearest);
                continue;
            }
            disparity = kDispMissing;
            maps.confidence.row(y)[x] = 0;
            maps.verdict.row(y)[x] = Verdict::kMismatched;
        }
    }
}

void drop_clipped(const Maps& maps, int min_disparity)
{
    for (int y = 0; y < maps.disparity.height; ++y) {
        for (int x = 0; x < maps.disparity.width; ++x) {
            Verdict& verdict = maps.verdict.row(y)[x];
            const int disparity = min_disparity + ((maps.disparity.row(y)[x] + 128) >> kDispFractionBits);
            if (verdict == Verdict::kMatched && x - disparity < kRim)
                verdict = Verdict::kMismatched;
        }
    }
}

void drop_speckles(const Maps& maps, std::span<std::uint8_t> large)
{
    for (int y = 0; y < maps.disparity.height; ++y) {
        for (int x = 0; x < maps.disparity.width; ++x) {
            if (maps.verdict.row(y)[x] != Verdict::kMatched)
                continue;
            // Most pixels belong to the large island of a neighbour that was looked at before: large[x - 1] is of this
            // row, large[x] still of the row above.
            const auto column = static_cast<std::size_t>(x);
            if ((x > 0 && large[column - 1] && hang_together(maps, {x, y}, {x - 1, y})) ||
                (y > 0 && large[column] && hang_together(maps, {x, y}, {x, y - 1}))) {
                large[column] = 1;
                continue;
            }
            const Island island = island_of(maps, {x, y});
            large[column] = island.size == kLeastIsland;
            if (!large[column])
                for (int i = 0; i < island.size; ++i) {
                    const Position p = island.pixels[static_cast<std::size_t>(i)];
                    maps.verdict.row(p.y)[p.x] = Verdict::kMismatched;
                }
        }
    }
}

} // namespace dicot::matching
