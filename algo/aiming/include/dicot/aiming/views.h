// What two cameras see in common, and how they stand to each other, out of one raw pair: no calibration.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/image.h"
#include "dicot/base/status.h"

#include <cstdint>

namespace dicot::aiming {

/// Whether the picture called left is the left one.
enum class Order : std::uint8_t
{
    kNotKnown, ///< too few matches, hardly a shift, or shifts both ways (cameras turned towards each other)
    kAsNamed,  ///< what is in view lies further to the right in the left picture, as it should
    kSwapped,  ///< the opposite: left is right
};

/// "as named": for reports.
const char* name_of(Order order) noexcept;

/// Figures of one pair. Pixels are those of the pictures given, as the cameras gave them.
struct Views
{
    int matches = 0; ///< patches found in both pictures, and agreeing with a common picture geometry
    int patches = 0; ///< distinctive patches looked for

    /// With fewer matches nothing below is known, and all of it is 0.
    static constexpr int kFewestMatches = 24;
    bool known() const { return matches >= kFewestMatches; }

    double shift_px = 0;      ///< median of x_left - x_right
    double shift_low_px = 0;  ///< one match in ten shifts less
    double shift_high_px = 0; ///< one match in ten shifts more
    /// y_right - y_left in the middle of the picture: above 0 the right camera looks too high.
    double vertical_px = 0;
    /// By how much the right camera is turned clockwise against the left one, seen from behind the cameras.
    double roll_deg = 0;
    /// Share of the left picture that the right one shows too, if all lay at the median shift.
    int overlap_percent = 0;
    Order order = Order::kNotKnown;
};

/// Pictures that compare_views() takes.
inline constexpr int kMinViewSide = 96;   ///< px
inline constexpr int kMaxViewSide = 4096; ///< px

/// Bytes that compare_views() takes from its arena for pictures of this size.
std::size_t view_scratch_bytes(int width, int height) noexcept;

/// Compares two grey pictures of one size, taken at the same moment, not rectified. Looks for patches up to a half of
/// the width to either side and an eighth of the height up and down. The arena is given back as it was. The same
/// pictures give the same figures on every CPU.
///
/// Cameras that look at one point in front of them (toe-in) shift what lies behind it the wrong way: if nothing else is
/// in view they look swapped, and one pair cannot tell. Mount them parallel, or take the order from a calibration.
///
/// Errors: kBadData for pictures of different sizes or outside kMinViewSide .. kMaxViewSide; kConfig when the arena is
/// too small.
Result<Views> compare_views(ImageView<const std::uint8_t> left, ImageView<const std::uint8_t> right, Arena& scratch);

} // namespace dicot::aiming
