// Clouds of real and of rendered pairs, as `dicot process` sees them before they are compressed.
#pragma once

#include "dicot/base/cloud.h"

#include <cstddef>
#include <string>
#include <vector>

namespace dicot::test {

struct BenchCloud
{
    std::string name;
    bool plant = false;
    std::vector<CloudPoint> points; ///< row by row
    CloudGrid grid;
    double focal_px = 0;
    std::size_t ply_bytes = 0;
    std::size_t pcd_bytes = 0; ///< PCD, binary_compressed; 0 when pcl-tools are not installed

    PointCloud cloud() const { return {points, grid}; }
};

/// Those whose pictures are there, says which are not.
std::vector<BenchCloud> bench_clouds();

} // namespace dicot::test
