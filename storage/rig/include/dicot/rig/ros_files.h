// ROS camera_info YAML pairs: left.yaml and right.yaml in one folder.
#pragma once

#include "dicot/rig/rig_file.h"

#include <span>
#include <string>

namespace dicot {

/// Writes both files into `folder`, which must be there. Lengths are in metres, as ROS has them: the right camera's
/// P[0,3] is -fx * baseline. camera_info knows no R and T between the cameras; rectification_matrix and
/// projection_matrix hold them. `name` is the rig's.
///
/// Both files are on the disk before either appears, so a write that fails leaves the former pair. They appear one
/// after the other: only when power fails in between, or the second rename does, is a new left.yaml beside an old
/// right.yaml, and read_ros_files() refuses what does not belong together.
///
/// Fault::kBadData: K, R1, R2, P1 or P2 missing, distortion of more than 8 numbers, R1 R2 P2 that do not belong to R
/// and T.
Status write_ros_files(const RigFile& rig, const std::string& folder, const char* name);

/// Reads both; R and T follow from the rectifying rotations and P2, Q from P1 and P2. Faults as read_rig_file(), and
/// Fault::kBadData for projections that are not of one rectified pair. Allocates: for start-up only.
Result<RigFile> read_ros_files(const std::string& folder);

/// The same out of the texts of both files; `folder` stands in the sentences.
Result<RigFile> parse_ros(std::span<const std::byte> left, std::span<const std::byte> right, const std::string& folder);

} // namespace dicot
