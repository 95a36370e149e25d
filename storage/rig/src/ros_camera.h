// One camera_info file.
#pragma once

#include "dicot/rig/rig_file.h"

#include <span>
#include <string>

namespace dicot {

struct RosCamera
{
    int width = 0;
    int height = 0;
    RigCamera camera; ///< whole; lengths in mm
};

/// Fault::kBadData: something is missing, has another shape or another lens model than plumb_bob and
/// rational_polynomial.
Result<RosCamera> parse_ros_camera(std::span<const std::byte> text, const char* name);

/// The text of the file. The camera has all four matrices, and 8 numbers of distortion at most.
std::string ros_text_of(const RosCamera& camera, const char* camera_name);

} // namespace dicot
