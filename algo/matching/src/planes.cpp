#include "planes.h"

#include <algorithm>

namespace dicot::matching {
namespace {

constexpr PairS16 kOutsideLa = {kLabOutside, 0};
constexpr PairS16 kOutsideB = {0, 0};

// ITU-R BT.601 luma, Q8.
int grey(Rgb8 p)
{
    return (77 * p.r + 150 * p.g + 29 * p.b) >> 8;
}

// 3 x 3 census (eq. 11): one bit a neighbour, set where it is darker than the centre; borders repeat.
std::uint8_t census(const Rgb8* const rows[3], int x, int width)
{
    const int centre = grey(rows[1][x]);
    unsigned bits = 0;
    for (int dy = 0; dy < 3; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            if (dy != 1 || dx != 0)
                bits = (bits << 1) | (grey(rows[dy][std::clamp(x + dx, 0, width - 1)]) < centre ? 1u : 0u);
    return static_cast<std::uint8_t>(bits);
}

} // namespace

void Planes::lay_out(Arena& arena, int width, int height, int margin_left, int margin_right)
{
    height_ = height;
    margin_left_ = margin_left;
    stride_ = margin_left + width + margin_right;
    const auto row = static_cast<std::size_t>(stride_);
    const auto rows = static_cast<std::size_t>(height);
    la_ = arena.take<PairS16>(row * (rows + 1));
    b_ = arena.take<PairS16>(row * (rows + 1));
    red_ = arena.take<std::uint8_t>(row * rows);
    green_ = arena.take<std::uint8_t>(row * rows);
    blue_ = arena.take<std::uint8_t>(row * rows);
    census_ = arena.take<std::uint8_t>(row * rows);
    std::fill(la_.begin(), la_.end(), kOutsideLa);
    std::fill(b_.begin(), b_.end(), kOutsideB);
    for (auto plane : {red_, green_, blue_, census_})
        std::fill(plane.begin(), plane.end(), std::uint8_t{0});
}

void Planes::fill_rows(ImageView<const Rgb8> picture, int shift, const LabTables& tables, int from, int to)
{
    const int right_end = stride_ - margin_left_;
    const int first = std::max(-margin_left_, shift);
    const int last = std::min(right_end, picture.width + shift);
    const auto clamped_row = [&](int y) { return picture.row(std::clamp(y, 0, picture.height - 1)); };
    for (int y = from; y < to; ++y) {
        const Rgb8* rows[3] = {clamped_row(y - 1), picture.row(y), clamped_row(y + 1)};
        for (int column = first; column < last; ++column) {
            const int x = column - shift;
            const std::size_t at = offset(y, column);
            const Rgb8 p = rows[1][x];
            const LabPixel lab = lab_of(p, tables);
            la_[at] = {lab.l, lab.a};
            b_[at] = {lab.b, 0};
            red_[at] = p.r;
            green_[at] = p.g;
            blue_[at] = p.b;
            census_[at] = census(rows, x, picture.width);
        }
    }
}

LabRow Planes::lab(int y) const
{
    const std::size_t at = offset(y < 0 || y >= height_ ? height_ : y, 0);
    return {la_.data() + at, b_.data() + at};
}

CostRow Planes::cost(int y) const
{
    const std::size_t at = offset(y, 0);
    return {red_.data() + at, green_.data() + at, blue_.data() + at, census_.data() + at};
}

} // namespace dicot::matching
