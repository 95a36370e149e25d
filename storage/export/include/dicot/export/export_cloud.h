// Clouds in the formats that other programs open.
#pragma once

#include "dicot/base/cloud.h"
#include "dicot/base/status.h"
#include "dicot/codec/cloud_meta.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

inline constexpr std::size_t kPlyBytesPerPoint = 19;

/// Numbers for each point, 0 for none; both empty where there are none at all.
struct PointNumbers
{
    std::span<const std::uint16_t> leaf;
    std::span<const std::uint8_t> plant;
};

/// PLY 1.0, binary little-endian: x y z float (metres), red green blue uchar, confidence float (0..1); comments give
/// unit, frame and what else `meta` knows. With `numbers` also leaf ushort and plant uchar. Durable or absent.
Status write_ply(const char* path, const PointCloud& cloud, const CloudMeta& meta, const PointNumbers& numbers = {});

/// PCD 0.7, binary: x y z float (metres), rgb packed into a float as PCL expects it, confidence float (0..1).
/// Durable or absent.
Status write_pcd(const char* path, const PointCloud& cloud, const CloudMeta& meta);

/// Chooses by the end of the name: .ply or .pcd. Fault::kUsage for others.
Status export_cloud(const char* path, const PointCloud& cloud, const CloudMeta& meta);

} // namespace dicot
