// Where the description of a rig may come from.
#pragma once

#include "dicot/rig/rig_file.h"

#include <string>

namespace dicot::app {

inline constexpr const char* kRigSourceWords =
    "rig file, or folder of a ROS camera_info pair (left.yaml, right.yaml) or of OpenCV's stereo_calib "
    "(intrinsics.yml, extrinsics.yml)";

bool is_folder(const std::string& path);

/// Reads a rig file whose numbers will be used. One that was edited by hand since it was named gets its true id, and a
/// sentence on stderr. Errors: those of read_rig_file().
Result<RigFile> read_rig_for_use(const std::string& path);

/// A rig file, or the folder of a camera_info pair or of OpenCV's stereo_calib, with R1 R2 P1 P2 Q where the cameras
/// are known and one of them is missing. Errors: those of read_rig_file(), read_ros_files(), read_opencv_files(),
/// stereo_rig_of() and rectify(); Fault::kUsage: hints about a camera_info pair, which leaves nothing open.
Result<RigFile> read_whole_rig(const std::string& path, const RigHints& hints = {});

} // namespace dicot::app
