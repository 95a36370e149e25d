#include "bench_clouds.h"

#include "temp_folder.h"
#include "tool.h"

#include "dicot/codec/decode_cloud.h"
#include "dicot/export/export_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <span>
#include <stdexcept>

namespace dicot::test {
namespace {

/// Cones as a pair of webcams would see them, 60 mm apart: what is 14 to 55 px there is 0.4 to 1.7 m away.
constexpr const char* kWebcamRig = R"(%YAML:1.0
---
image_width: 450
image_height: 375
near_mm: 420
far_mm: 1700
P1: !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [ 400., 0., 225., 0., 0., 400., 187., 0., 0., 0., 1., 0. ]
P2: !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [ 400., 0., 225., -24000., 0., 400., 187., 0., 0., 0., 1., 0. ]
)";

struct Pair
{
    const char* name;
    const char* left; ///< in the folder of data
    const char* right;
    const char* rig;
    double focal_px;
    bool plant;
};

constexpr const char* kRendered = "rig-dev/calibration/gt_calib.yml --near-mm 350 --far-mm 1200";
constexpr Pair kPairs[] = {
    {"Aloe", "plants/aloe-third/left.png", "plants/aloe-third/right.png", nullptr, 1246.7, true},
    {"Cones", "middlebury-v2/cones/left.png", "middlebury-v2/cones/right.png", kWebcamRig, 400, false},
    {"strawberry", "rig-dev/plants/p3_strawberry/sunny_left.jpg", "rig-dev/plants/p3_strawberry/sunny_right.jpg",
     kRendered, 780, true}};

std::string rig_of(const Pair& pair, const TempFolder& folder)
{
    if (pair.rig == nullptr)
        return std::string{DICOT_TEST_DATA} + "/aloe-third.yaml";
    if (pair.rig == kWebcamRig)
        return folder.write("rig.yaml", std::string{kWebcamRig});
    return std::string{DICOT_DATA_DIR} + "/" + pair.rig;
}

/// Out of a PLY that dicot wrote: nothing is rounded yet there.
std::vector<CloudPoint> points_of(const Bytes& ply, const CloudGrid& grid)
{
    constexpr std::ptrdiff_t kVertexBytes = 19; // float x, y, z; uchar red, green, blue; float confidence
    const std::string mark = "end_header\n";
    auto at = std::search(ply.begin(), ply.end(), mark.begin(), mark.end());
    if (at == ply.end())
        throw std::runtime_error("no PLY");
    std::vector<CloudPoint> points;
    for (at += static_cast<std::ptrdiff_t>(mark.size()); ply.end() - at >= kVertexBytes; at += kVertexBytes) {
        float metres[3];
        float confidence = 0;
        std::memcpy(metres, &*at, sizeof metres);
        std::memcpy(&confidence, &*(at + 15), sizeof confidence);
        const auto steps = [&](int axis) {
            return static_cast<std::int32_t>(std::lround(static_cast<double>(metres[axis]) * 1e6 / grid.step_um));
        };
        points.push_back({steps(0),
                          steps(1),
                          steps(2),
                          {at[12], at[13], at[14]},
                          static_cast<std::uint8_t>(std::lround(confidence * 255.0F))});
    }
    return points;
}

std::size_t compressed_pcd_bytes(const PointCloud& cloud, const TempFolder& folder)
{
    const std::string plain = folder.path("cloud.pcd");
    const std::string packed = folder.path("packed.pcd");
    if (!export_cloud(plain.c_str(), cloud, {}).ok() ||
        run("pcl_convert_pcd_ascii_binary " + plain + " " + packed + " 2").exit_code != 0)
        return 0;
    return std::filesystem::file_size(packed);
}

} // namespace

std::vector<BenchCloud> bench_clouds()
{
    const std::string data = std::string{DICOT_DATA_DIR} + "/";
    std::vector<BenchCloud> clouds;
    for (const Pair& pair : kPairs) {
        if (!std::filesystem::exists(data + pair.left)) {
            std::printf("NOT RUN: %s: %s%s is not there\n", pair.name, data.c_str(), pair.left);
            continue;
        }
        const TempFolder folder;
        const std::string drc = folder.path("cloud.drc");
        const std::string ply = folder.path("cloud.ply");
        const ToolRun made = run(std::string{DICOT_PROGRAM} + " process " + data + pair.left + " " + data + pair.right +
                                 " --rig " + rig_of(pair, folder) + " -o " + drc + " --ply " + ply);
        if (made.exit_code != 0)
            throw std::runtime_error(made.output);
        const Bytes file = bytes_of(drc);
        BenchCloud cloud;
        cloud.name = pair.name;
        cloud.grid = outline_of(std::as_bytes(std::span{file}), drc.c_str()).value().grid;
        cloud.plant = pair.plant;
        cloud.focal_px = pair.focal_px;
        cloud.ply_bytes = std::filesystem::file_size(ply);
        cloud.points = points_of(bytes_of(ply), cloud.grid);
        cloud.pcd_bytes = compressed_pcd_bytes(cloud.cloud(), folder);
        clouds.push_back(std::move(cloud));
    }
    return clouds;
}

} // namespace dicot::test
