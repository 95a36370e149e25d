#include "patches.h"

#include <algorithm>
#include <cstdlib>

namespace dicot::aiming {
namespace {

/// One patch is chosen of each cell of so many pixels a side.
constexpr int kCell = 5;
constexpr int kCellOfSmallest = 3;
/// A patch reaches from -kHalf to kHalf - 1.
constexpr int kHalf = 4;
/// The least change of grey, squared, in the direction in which a patch changes least.
constexpr int kLeastCorner = 4;
/// Of 64 bits: the largest distance of a match, and by how much the second best place must be worse.
constexpr int kMaxDistance = 16;
constexpr int kLeastLead = 3;
/// Places as near as this to the best one are the same place.
constexpr int kSamePlace = 2;

constexpr int reach_x(int width)
{
    return width / 2;
}
constexpr int reach_y(int height)
{
    return height / 8;
}

int bits_set(std::uint64_t word)
{
    word -= (word >> 1) & 0x5555555555555555u;
    word = (word & 0x3333333333333333u) + ((word >> 2) & 0x3333333333333333u);
    word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return static_cast<int>((word * 0x0101010101010101u) >> 56);
}

std::uint64_t bits_at(Grey picture, int x, int y)
{
    int sum = 0;
    for (int dy = -kHalf; dy < kHalf; ++dy)
        for (int dx = -kHalf; dx < kHalf; ++dx)
            sum += picture.row(y + dy)[x + dx];
    std::uint64_t bits = 0;
    for (int dy = -kHalf; dy < kHalf; ++dy)
        for (int dx = -kHalf; dx < kHalf; ++dx)
            bits = bits << 1 | static_cast<std::uint64_t>(picture.row(y + dy)[x + dx] * 4 * kHalf * kHalf > sum);
    return bits;
}

/// Places whose patch lies within the picture.
struct Inside
{
    int width, height;

    int first() const { return kHalf; }
    int last_x() const { return width - kHalf; }
    int last_y() const { return height - kHalf; }
    std::size_t index(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

void fill_bits(Grey picture, std::span<std::uint64_t> bits)
{
    const Inside inside{picture.width, picture.height};
    for (int y = inside.first(); y <= inside.last_y(); ++y)
        for (int x = inside.first(); x <= inside.last_x(); ++x)
            bits[inside.index(x, y)] = bits_at(picture, x, y);
}

/// The smaller eigenvalue of the gradients' scatter around a pixel, about: determinant by trace.
std::int32_t corner_at(Grey picture, int x, int y)
{
    constexpr int kRadius = 2;
    std::int64_t xx = 0, yy = 0, xy = 0;
    for (int dy = -kRadius; dy <= kRadius; ++dy) {
        const std::uint8_t* const row = picture.row(y + dy) + x;
        const std::uint8_t* const above = picture.row(y + dy - 1) + x;
        const std::uint8_t* const below = picture.row(y + dy + 1) + x;
        for (int dx = -kRadius; dx <= kRadius; ++dx) {
            const int gx = row[dx + 1] - row[dx - 1];
            const int gy = below[dx] - above[dx];
            xx += gx * gx;
            yy += gy * gy;
            xy += gx * gy;
        }
    }
    constexpr int kPixels = (2 * kRadius + 1) * (2 * kRadius + 1);
    return static_cast<std::int32_t>((xx * yy - xy * xy) / (xx + yy + 1) / kPixels);
}

struct Found
{
    int x = 0, y = 0;
    int distance = 65;
    int second = 65; ///< the least distance elsewhere
};

/// The best place in `bits` for a patch, within the reach around its own.
Found search(const Inside& inside, std::uint64_t patch, std::span<const std::uint64_t> bits, const Found& around,
             std::span<std::uint8_t> distance)
{
    const int left = std::max(inside.first(), around.x - reach_x(inside.width));
    const int right = std::min(inside.last_x(), around.x + reach_x(inside.width));
    const int top = std::max(inside.first(), around.y - reach_y(inside.height));
    const int bottom = std::min(inside.last_y(), around.y + reach_y(inside.height));
    const int columns = right - left + 1;

    Found found;
    std::uint8_t* out = distance.data();
    for (int row = top; row <= bottom; ++row) {
        const std::uint64_t* const words = &bits[inside.index(left, row)];
        int least = found.distance, at = -1;
        for (int i = 0; i < columns; ++i) {
            const int bad = bits_set(words[i] ^ patch);
            out[i] = static_cast<std::uint8_t>(bad);
            if (bad < least) {
                least = bad;
                at = i;
            }
        }
        if (at >= 0)
            found = {left + at, row, least, found.second};
        out += columns;
    }
    if (found.distance > kMaxDistance)
        return found;
    const std::uint8_t* in = distance.data();
    for (int row = top; row <= bottom; ++row, in += columns)
        for (int i = 0; i < columns; ++i) {
            const bool same = std::abs(row - found.y) <= kSamePlace && std::abs(left + i - found.x) <= kSamePlace;
            if (in[i] < found.second && !same)
                found.second = in[i];
        }
    return found;
}

bool stands_out(const Found& found)
{
    return found.distance <= kMaxDistance && found.second >= found.distance + kLeastLead;
}

/// The pixel of a cell that stands out most; x < 0 if none does.
Found corner_of(Grey picture, int cell_x, int cell_y, int cell)
{
    const Inside inside{picture.width, picture.height};
    Found found{-1, -1};
    std::int32_t best = kLeastCorner - 1;
    for (int y = std::max(cell_y, inside.first()); y < std::min(cell_y + cell, inside.last_y()); ++y)
        for (int x = std::max(cell_x, inside.first()); x < std::min(cell_x + cell, inside.last_x()); ++x)
            if (const std::int32_t corner = corner_at(picture, x, y); corner > best) {
                best = corner;
                found = {x, y};
            }
    return found;
}

/// Appends the pairs of one level to the first `count` of the table; returns how many there are then.
std::size_t find_in_level(Grey left, Grey right, int level, int cell, PatchTable& table, std::size_t count)
{
    const Inside inside{left.width, left.height};
    fill_bits(left, table.left_bits);
    fill_bits(right, table.right_bits);
    for (int cell_y = 0; cell_y + cell <= left.height; cell_y += cell)
        for (int cell_x = 0; cell_x + cell <= left.width; cell_x += cell) {
            const Found here = corner_of(left, cell_x, cell_y, cell);
            if (here.x < 0)
                continue;
            ++table.patches;
            const Found there =
                search(inside, table.left_bits[inside.index(here.x, here.y)], table.right_bits, here, table.distance);
            if (!stands_out(there))
                continue;
            const Found back = search(inside, table.right_bits[inside.index(there.x, there.y)], table.left_bits, there,
                                      table.distance);
            if (stands_out(back) && std::abs(back.x - here.x) <= 1 && std::abs(back.y - here.y) <= 1)
                table.pairs[count++] = {level, here.x, here.y, there.x, there.y};
        }
    return count;
}

const Grey& searched_first(const Levels& levels)
{
    return levels.level[static_cast<std::size_t>(std::max(levels.count - 2, 0))];
}

constexpr std::size_t cells(int width, int height, int cell)
{
    return static_cast<std::size_t>(width / cell) * static_cast<std::size_t>(height / cell);
}

} // namespace

std::size_t PatchTable::most_pairs(const Levels& levels)
{
    const Grey &large = searched_first(levels), &small = levels.smallest();
    return cells(large.width, large.height, kCell) + cells(small.width, small.height, kCellOfSmallest);
}

PatchTable PatchTable::lay_out(Arena& arena, const Levels& levels)
{
    const int width = searched_first(levels).width, height = searched_first(levels).height;
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const std::size_t window =
        static_cast<std::size_t>(2 * reach_x(width) + 1) * static_cast<std::size_t>(2 * reach_y(height) + 1);
    PatchTable table;
    table.left_bits = arena.take<std::uint64_t>(pixels);
    table.right_bits = arena.take<std::uint64_t>(pixels);
    table.distance = arena.take<std::uint8_t>(window);
    table.pairs = arena.take<Pair>(most_pairs(levels));
    return table;
}

std::span<Pair> find_pairs(const Levels& left, const Levels& right, PatchTable& table)
{
    table.patches = 0;
    const int last = left.count - 1;
    std::size_t count = find_in_level(left.smallest(), right.smallest(), last, kCellOfSmallest, table, 0);
    if (last > 0)
        count = find_in_level(searched_first(left), searched_first(right), last - 1, kCell, table, count);
    return table.pairs.first(count);
}

} // namespace dicot::aiming
