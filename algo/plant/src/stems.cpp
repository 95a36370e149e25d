#include "stems.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace dicot {
namespace {

/// A piece is a stem where it is paler than its plant, narrower than its leaves usually are, and
///
///     narrowness / usual > 4 (slope + 1/5) (1 + greenness / 10)
///
/// narrowness: points by the square of the half width; usual: the plant's own, so that grass stays; slope: of depth
/// across the piece's length, tangent of the angle to the picture; greenness: green by the sum of the channels, in per
/// cent more than the plant's. A cylinder faces the camera across its length whichever way it stands; a blade as narrow
/// is mostly one that is seen along its surface. Stems hold less chlorophyll than blades. The form follows a logistic
/// regression on the rendered plants, species left out in turn.
constexpr double kNarrow = 4, kLeastSlope = 0.2, kPale = 10, kPaler = 1.5, kNarrower = 1.2;
constexpr double kPalest = 0.5; ///< more, and it is light on a blade
/// Whatever its form, a piece is no leaf of a plant that has another hue: a pot's glaze. In per cent of the sum of the
/// channels: less of green, and less of red minus blue, by so much.
constexpr double kLessGreen = 7, kLessRed = 10;

/// Sums over points.
struct Form
{
    double count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    double inverse = 0, x_inverse = 0, y_inverse = 0;
    double greenness = 0, redness = 0;
    double half_width_px = 0;
    std::uint8_t plant = 0;

    void add(double column, double row, double value, const Rgb8& colour)
    {
        ++count;
        x += column;
        y += row;
        xx += column * column;
        xy += column * row;
        yy += row * row;
        inverse += value;
        x_inverse += column * value;
        y_inverse += row * value;
        constexpr int kDark = 3; // black is grey
        const double percent = 100.0 / (colour.r + colour.g + colour.b + kDark);
        greenness += percent * (colour.g + 1);
        redness += percent * (colour.r - colour.b);
    }

    double narrowness() const { return count / (half_width_px * half_width_px); }

    /// Of depth in the direction in which the points reach least far, tangent.
    double slope_across(double focal_px) const
    {
        const double along_x = xx - x * x / count, along_y = yy - y * y / count, both = xy - x * y / count;
        const double with_x = x_inverse - x * inverse / count, with_y = y_inverse - y * inverse / count;
        const double half = (along_x - along_y) / 2, root = std::sqrt(half * half + both * both);
        const double least = (along_x + along_y) / 2 - root;
        if (!(least > 0) || !(root > 0))
            return 0;
        // The eigenvector of the lesser spread, of the two ways to write it the longer one.
        const double u = half > 0 ? -both : half - root, v = half > 0 ? half + root : both;
        const double steps = (u * with_x + v * with_y) / (least * std::sqrt(u * u + v * v));
        return std::fabs(steps) * focal_px * count / inverse;
    }
};

/// Of a plant, over its points.
struct Usual
{
    double count = 0, greenness = 0, redness = 0, narrowness = 0;
};

bool is_leaf(const Form& form, const Usual& usual, double focal_px)
{
    const double greener = form.greenness / form.count - usual.greenness / usual.count;
    const double redder = form.redness / form.count - usual.redness / usual.count;
    if (greener < -kLessGreen && redder < -kLessRed)
        return false;
    const double narrower = form.narrowness() * usual.count / usual.narrowness;
    return greener > -kPaler || narrower < kNarrower ||
           narrower < kNarrow * (form.slope_across(focal_px) + kLeastSlope) * std::max(kPalest, 1 + greener / kPale);
}

} // namespace

void drop_stems(const PlantView& view, const Surface& surface, Pieces& pieces, Arena& arena)
{
    const std::size_t mark = arena.used();
    const std::span<Form> forms = arena.take<Form>(static_cast<std::size_t>(pieces.count) + 1);
    if (arena.overrun())
        return;
    std::ranges::fill(forms, Form{});
    const auto width = static_cast<std::size_t>(surface.width);
    for (std::size_t i = 0; i < surface.cells(); ++i) {
        if (pieces.piece[i] == 0)
            continue;
        Form& form = forms[static_cast<std::size_t>(pieces.piece[i])];
        form.half_width_px = std::max(form.half_width_px, double(surface.inside_px5[i]) / Surface::kUnit);
        if (surface.cell[i] != Surface::kPoint)
            continue;
        const auto point = static_cast<std::size_t>(surface.point(view, i));
        const std::size_t column = i % width, row = i / width;
        form.add(double(column), double(row), double{surface.inverse[i]}, view.cloud.points[point].colour);
        form.plant = surface.plant[i];
    }
    std::array<Usual, UINT8_MAX + 1> usual{};
    for (const Form& form : forms)
        if (form.count > 0) {
            Usual& of = usual[form.plant];
            of.count += form.count;
            of.greenness += form.greenness;
            of.redness += form.redness;
            of.narrowness += form.count * form.narrowness();
        }
    for (Form& form : forms)
        if (form.count > 0 && !is_leaf(form, usual[form.plant], surface.focal_px))
            form.count = 0;
    for (std::int32_t& piece : pieces.piece)
        if (forms[static_cast<std::size_t>(piece)].count == 0)
            piece = 0;
    arena.rewind(mark);
}

} // namespace dicot
