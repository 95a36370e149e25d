// What a dequeued buffer is worth, and when its picture was taken. Pure.
#pragma once

#include "dicot/camera/frame.h"

#include <cstddef>
#include <cstdint>
#include <span>

#include <linux/videodev2.h>

namespace dicot::v4l2 {

/// Sets bytes, verdict and flaw of `frame`, whose mode is set. `mapped` is the buffer's memory; a driver's bytesused
/// beyond it is not believed. The flaw is written to `flaw`.
///
/// Torn: the driver's error flag; no bytes; not exactly the bytes of an uncompressed mode; MJPEG that does not begin
/// with FF D8 or end with FF D9 (zeros behind it are padding).
void judge(const v4l2_buffer& buffer, std::span<const std::byte> mapped, Frame& frame, std::span<char> flaw) noexcept;

/// Start of exposure in microseconds of CLOCK_MONOTONIC: the driver's stamp where it is of that clock, less one frame
/// interval where it was taken at the end of the frame. A stamp in the future or more than 10 s old is not believed:
/// then, and with other clocks, it is one interval before `now_us`.
std::int64_t start_us(const v4l2_buffer& buffer, std::uint32_t interval_100ns, std::int64_t now_us) noexcept;

/// Frames between the expected sequence and this one; 0 when the driver counts backwards.
std::uint32_t lost_between(std::uint32_t expected, std::uint32_t sequence) noexcept;

} // namespace dicot::v4l2
