// Disparities between whole pixels, on surfaces that slant: where a second look at both pictures puts them.
#pragma once

#include "cost_rows.h"
#include "dicot/base/work.h"
#include "refine.h"

#include <span>

namespace dicot::matching {

/// A pixel's disparity and how it changes towards its neighbours.
struct Slope
{
    std::int32_t disparity; ///< relative, px with kSlopeBits fraction bits; kNoSlope where there is none
    std::int16_t across;    ///< px a column, kSlopeBits fraction bits
    std::int16_t down;      ///< px a row, the same
};
inline constexpr int kSlopeBits = 12;
inline constexpr std::int32_t kNoSlope = INT32_MIN;

/// The winners' windows are parallel to the picture and their parabola pulls towards whole pixels. This goes by the
/// pictures' brightness instead (Lucas and Kanade 1981, with one unknown a pixel, the disparity, and the brightness
/// between the cameras as the second): each neighbour is looked up in the right picture at its own disparity, so the
/// surface may slant and bend. Between the rounds planes are fitted to the neighbourhood, in which a pixel counts as
/// much as its texture tells. Both with the support weights of the left picture and only among neighbours that lie on
/// the same plane.
class SurfaceRefiner
{
public:
    /// How far the neighbourhood reaches, px: the planes' margins must be as wide.
    static constexpr int kReach = 8;

    /// Memory for pictures of the scene's size. What it holds lives only during refine().
    void lay_out(Arena& arena, const Scene& scene);

    /// Moves every disparity that is not missing and gives it a confidence: high where the pictures agree, there
    /// is texture to tell, the neighbours lie on the same plane and are as sure, and the surface is near. Without
    /// `dense`, what deserves none loses its disparity; with it, nothing does, and nothing moves by more than half a
    /// pixel.
    void refine(const Scene& scene, const Maps& maps, bool dense, Crew& crew);

private:
    void read_brightness(const Scene& scene, Crew& crew);
    void look_up(const Scene& scene, const Maps& maps, Crew& crew);
    void shift_row(const Scene& scene, const Maps& maps, int y);
    void fit_row(const Scene& scene, int y, int same_surface);
    void fit_planes(const Scene& scene, Crew& crew, int same_surface);
    void run_rounds(const Scene& scene, const Maps& maps, int rounds, Crew& crew);

    /// Calls visit(plane) with the planes of the neighbours that are not too doubtful, as they are at (x, y).
    template <typename Visit>
    void visit_planes(const Scene& scene, int x, int y, Visit&& visit) const;
    /// How much the pictures differ around (x, y) if it shows that plane, 1/256 grey level: the mean over neighbours
    /// that resemble it in the left picture and its partner in the right one.
    template <typename Neighbours>
    int mismatch(const Scene& scene, int x, int y, Slope plane, const Neighbours& neighbours) const;
    /// The neighbours' plane that is nearest to `winner` and within a pixel of it, or none.
    Slope nearest_plane(const Scene& scene, int x, int y, std::int32_t winner) const;
    void choose_row(const Scene& scene, const Maps& maps, int y);
    /// Writes the disparities, and adds what speaks against the winner to the doubt.
    void settle_row(const Scene& scene, const Maps& maps, int y, bool dense);
    /// The doubt of a neighbour on the same plane as (x, y); kHopeless of others.
    int doubt_on_plane(const Scene& scene, int x, int y, int dx, int dy) const;
    /// Takes the disparities away that deserve none, and gives the others their confidence.
    void rate_row(const Scene& scene, const Maps& maps, int y, bool dense) const;

    ImageView<std::int16_t> left_, right_;          ///< brightness, 1/16 grey level
    ImageView<std::int16_t> difference_, gradient_; ///< left minus right at the disparity; 64 x grey levels a px
    ImageView<std::uint16_t> texture_;              ///< what a pixel's neighbourhood tells about it
    ImageView<std::int16_t> doubt_;                 ///< logarithm of what speaks against a disparity, 1/256
    ImageView<Slope> slopes_, next_;
};

} // namespace dicot::matching
