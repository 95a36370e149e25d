// The vertices of a PLY as dicot writes it.
#pragma once

#include "temp_folder.h"

#include "dicot/base/stereo_rig.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace dicot::test {

/// x, y, z of each vertex, in mm.
inline std::vector<Point3> ply_points_mm(const std::string& path)
{
    constexpr std::ptrdiff_t kVertexBytes = 19; // float x, y, z; uchar red, green, blue; float confidence
    const Bytes file = bytes_of(path);
    const std::string mark = "end_header\n";
    auto at = std::search(file.begin(), file.end(), mark.begin(), mark.end());
    if (at == file.end())
        throw std::runtime_error(path + " is no PLY");
    std::vector<Point3> points;
    for (at += static_cast<std::ptrdiff_t>(mark.size()); file.end() - at >= kVertexBytes; at += kVertexBytes) {
        float metres[3];
        std::memcpy(metres, &*at, sizeof metres);
        points.push_back({metres[0] * 1e3, metres[1] * 1e3, metres[2] * 1e3});
    }
    return points;
}

} // namespace dicot::test
