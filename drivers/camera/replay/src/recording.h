// A recorded frame on the disk.
#pragma once

#include "dicot/base/status.h"
#include "dicot/camera/mode.h"

#include <cstddef>
#include <span>

namespace dicot::replay {

struct Recording
{
    CameraMode mode;       ///< without a rate
    std::size_t bytes = 0; ///< of its frame
};

/// What a file holds: by its content, but raw frames by the ending .yuyv and the size in the name. Faults as
/// ReplayCamera::open() says.
Result<Recording> look_at(const char* path) noexcept;

/// Reads the frame; returns its bytes. `into` has room for what look_at() told; a file that has changed is refused.
Result<std::size_t> read_frame(const char* path, const CameraMode& mode, std::span<std::byte> into) noexcept;

/// A frame that is lit to `light` parts of `full`: towards black, colours towards grey. RGB24 and YUYV.
void darken(const CameraMode& mode, std::span<std::byte> frame, unsigned light, unsigned full) noexcept;

} // namespace dicot::replay
