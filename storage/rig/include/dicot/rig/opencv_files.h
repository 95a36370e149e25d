// The two files of OpenCV's sample stereo_calib: intrinsics.yml (M1 D1 M2 D2) and extrinsics.yml (R T R1 R2 P1 P2 Q).
#pragma once

#include "dicot/rig/rig_file.h"

#include <string>

namespace dicot {

/// Whether `folder` holds an intrinsics.yml.
bool holds_opencv_files(const std::string& folder);

/// Reads both files of `folder` as one rig. They name neither the pictures' size nor the unit of the board's squares,
/// in which their lengths are: `hints` should. Faults as read_rig_file(). Allocates: for start-up only.
Result<RigFile> read_opencv_files(const std::string& folder, const RigHints& hints);

} // namespace dicot
