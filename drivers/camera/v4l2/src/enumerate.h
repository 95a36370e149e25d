// What a device offers, with an end to every list that it may make endless.
#pragma once

#include "dicot/camera/control.h"
#include "dicot/camera/mode.h"

#include <cstddef>
#include <span>

namespace dicot::v4l2 {

/// Modes of formats that dicot reads, in the device's order; returns how many. Ranges of sizes and rates give the usual
/// ones within. Ends when `into` is full.
std::size_t list_modes(int descriptor, std::span<CameraMode> into) noexcept;
std::size_t list_controls(int descriptor, std::span<ControlRange> into) noexcept;

} // namespace dicot::v4l2
