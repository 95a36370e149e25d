// Clouds in the formats that other programs open.
#pragma once

#include "dicot/base/cloud.h"
#include "dicot/base/status.h"
#include "dicot/codec/cloud_meta.h"

#include <cstddef>

namespace dicot {

inline constexpr std::size_t kPlyBytesPerPoint = 19;

/// PLY 1.0, binary little-endian: x y z float (metres), red green blue uchar, confidence float (0..1); comments give
/// unit, frame and what else `meta` knows. Durable or absent.
Status write_ply(const char* path, const PointCloud& cloud, const CloudMeta& meta);

/// PCD 0.7, binary: x y z float (metres), rgb packed into a float as PCL expects it, confidence float (0..1).
/// Durable or absent.
Status write_pcd(const char* path, const PointCloud& cloud, const CloudMeta& meta);

/// Chooses by the end of the name: .ply or .pcd. Fault::kUsage for others.
Status export_cloud(const char* path, const PointCloud& cloud, const CloudMeta& meta);

} // namespace dicot
