// ROS camera_info YAML pairs: left.yaml and right.yaml in one folder.
#pragma once

#include "dicot/rig/rig_file.h"

#include <string>

namespace dicot {

/// Writes both files into `folder`, which must be there. Lengths are in metres, as ROS has them: the right camera's
/// P[0,3] is -fx * baseline. camera_info knows no R and T between the cameras; rectification_matrix and
/// projection_matrix hold them. Fault::kBadData: K, R1, R2, P1 or P2 missing, distortion of more than 8 numbers. `name`
/// is the rig's.
Status write_ros_files(const RigFile& rig, const std::string& folder, const char* name);

/// Reads both; R and T follow from the rectifying rotations and P2, Q stays unknown. Faults as read_rig_file().
/// Allocates: for start-up only.
Result<RigFile> read_ros_files(const std::string& folder);

} // namespace dicot
