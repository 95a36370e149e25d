// How sharp a camera's picture is, as a figure that two cameras and two moments can be compared by.
#pragma once

#include "dicot/base/image.h"

#include <array>
#include <cstdint>

namespace dicot::aiming {

/// Regions of a picture: 3 x 3, row after row.
inline constexpr int kFocusRegions = 9;

/// Figures of the picture as a whole: from kFocusSharp up it is in focus, below kFocusSoft a person sees the blur.
inline constexpr int kFocusSharp = 40;
inline constexpr int kFocusSoft = 25;

/// How steep the steps of grey in a picture are, 0 .. 100: the steepest difference of two neighbouring pixels in an
/// edge, as percent of the edge's whole height. 100 is a step from one pixel to the next, 50 one over two pixels, 10
/// one over ten; of the edges that a picture or a region has, four in five are below its figure, or at it.
///
/// A ratio within one edge, so light, contrast and what is in view hardly matter: the figures of both cameras and of
/// different moments stand on one scale. Steps that noise makes are not looked at.
struct Focus
{
    static constexpr int kUnknown = -1; ///< too few edges, e.g. a dark or an empty picture

    int whole = kUnknown;
    std::array<int, kFocusRegions> region{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown,
                                          kUnknown, kUnknown, kUnknown, kUnknown};
    int edges = 0; ///< counted, in the whole picture

    bool known() const { return whole != kUnknown; }
    friend bool operator==(const Focus&, const Focus&) = default;
};

/// Integers only, no memory. A picture below 32 pixels on a side is not known.
Focus focus_of(ImageView<const std::uint8_t> grey) noexcept;

} // namespace dicot::aiming
