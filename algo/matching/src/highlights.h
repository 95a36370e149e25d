// Light that a surface mirrors stands elsewhere in each view: matches that do not ask for the same brightness.
#pragma once

#include "cost_rows.h"
#include "dicot/base/work.h"
#include "refine.h"

namespace dicot::matching {

/// Beside pixels that a highlight has saturated, the pictures show one surface in two lights: brightness and contrast
/// differ, what is drawn on it does not. There the zero-mean normalised correlation of brightness finds what the costs
/// cannot. It is believed where the light really differs, and where most of what was asked around a pixel lies on one
/// plane, whose value the pixel takes.
class Highlights
{
public:
    /// Memory for pictures of the scene's size. What it holds lives only during match().
    void lay_out(Arena& arena, const Scene& scene);

    /// Gives pixels without a disparity, or with a confidence below kConfidence, that value with kConfidence and as
    /// matched where all of the above holds; others stay.
    void match(const Scene& scene, const Maps& maps, Crew& crew);

    static constexpr std::uint8_t kConfidence = 64;

private:
    void read_row(const Scene& scene, const Maps& maps, int y);
    void correlate_row(const Scene& scene, int y);
    void correlate(const Scene& scene, int y, int x0, int count);
    void settle_row(const Scene& scene, const Maps& maps, int y) const;

    ImageView<std::uint8_t> left_, right_; ///< brightness, grey levels
    ImageView<std::uint8_t> asked_;        ///< 1: without a disparity that is believed
    ImageView<std::uint8_t> differs_;      ///< mean brightness of both windows, 1/4 grey level apart
    ImageView<DispQ8> found_;              ///< best correlation, of even rows; kDispMissing where none is good
};

} // namespace dicot::matching
