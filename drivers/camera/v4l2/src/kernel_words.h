// V4L2's words and ours. Pure.
#pragma once

#include "dicot/camera/control.h"
#include "dicot/camera/mode.h"

#include <cstdint>
#include <optional>

#include <linux/videodev2.h>

namespace dicot::v4l2 {

std::optional<PixelFormat> format_of(std::uint32_t fourcc) noexcept;
std::uint32_t fourcc_of(PixelFormat format) noexcept; ///< 0: V4L2 devices are not asked for it

/// Seconds as a fraction, in 100 ns, rounded to the nearest; 0 of what is no time or more than 7 minutes.
std::uint32_t interval_of(const v4l2_fract& seconds) noexcept;
v4l2_fract fraction_of(std::uint32_t interval_100ns) noexcept;

std::uint32_t kernel_id(ControlId id) noexcept;

/// V4L2 counts its menu of exposure modes, UVC has a bit for each; everything else is the same number.
std::int32_t to_kernel(ControlId id, std::int32_t value) noexcept;
std::int32_t from_kernel(ControlId id, std::int32_t value) noexcept;

/// Nothing for what is disabled, write-only, or of a type without numbers.
std::optional<ControlRange> range_of(ControlId id, const v4l2_query_ext_ctrl& told) noexcept;

} // namespace dicot::v4l2
