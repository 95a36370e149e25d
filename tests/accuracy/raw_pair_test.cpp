// A rendered plant, pictures as the cameras gave them: the cloud against the true depth of every pixel.
#include "ply_points.h"
#include "rendered_maps.h"
#include "temp_folder.h"
#include "tool.h"

#include "dicot/picture/read_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace dicot {
namespace {

constexpr double kNearMm = 450;
constexpr double kFarMm = 1000;

/// A ground truth picture of the rendered rig.
struct Truth
{
    std::vector<float> values;
    ImageView<float> picture;

    Truth(const std::string& path, double scale)
    {
        const MapHead head = map_head(path.c_str()).value();
        values.resize(static_cast<std::size_t>(head.size.pixels()));
        picture = {values.data(), head.size.width, head.size.height};
        EXPECT_TRUE(read_map(path.c_str(), scale, picture).ok()) << path;
    }
};

struct Errors
{
    std::vector<double> mm;

    double median()
    {
        std::ranges::nth_element(mm, mm.begin() + static_cast<std::ptrdiff_t>(mm.size() / 2));
        return mm[mm.size() / 2];
    }
    double within_percent(double limit_mm) const
    {
        const auto count = std::ranges::count_if(mm, [=](double error) { return error <= limit_mm; });
        return 100.0 * static_cast<double>(count) / static_cast<double>(mm.size());
    }
};

TEST(RawPair, LeavesStandWithin2MmOfTheirTrueDepth)
{
    const std::string plants = std::string{DICOT_DATA_DIR} + "/rig-dev/plants/";
    const std::string plant = plants + "p1_epipremnum/";
    if (!std::filesystem::exists(plant + "overcast_left.jpg")) {
        std::printf("NOT RUN: RawPair.LeavesStandWithin2MmOfTheirTrueDepth: %s is not there\n", plant.c_str());
        return;
    }
    const test::TempFolder folder;
    const test::ToolRun run = test::run(std::string{DICOT_PROGRAM} + " process " + plant + "overcast_left.jpg " +
                                        plant + "overcast_right.jpg --rig " + plants + "gt_calib.yml --near-mm " +
                                        std::to_string(kNearMm) + " --far-mm " + std::to_string(kFarMm) + " -o " +
                                        folder.path("plant.drc") + " --ply " + folder.path("plant.ply"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const Truth depth_mm(plant + "gt_depth.png", 10);
    const Truth kind(plant + "gt_class.png", 1);
    constexpr float kLeaf = 1;

    const StereoRig rig = test::rendered_rig();
    const Turn back = transposed(rectify(rig, kCrop, "rig.yaml").value().left_rectifying);
    Errors leaves, all;
    for (const Point3& point : test::ply_points_mm(folder.path("plant.ply"))) {
        const Point3 in_camera = turned(back, point);
        const Point2 pixel = project(rig.left, in_camera);
        const int x = static_cast<int>(std::lround(pixel.x)), y = static_cast<int>(std::lround(pixel.y));
        if (x < 0 || y < 0 || x >= rig.width || y >= rig.height)
            continue;
        const double truth_mm = depth_mm.picture.at(x, y);
        if (!(truth_mm >= kNearMm && truth_mm <= kFarMm))
            continue;
        all.mm.push_back(std::fabs(in_camera.z - truth_mm));
        if (kind.picture.at(x, y) == kLeaf)
            leaves.mm.push_back(all.mm.back());
    }
    ASSERT_GT(leaves.mm.size(), 80000u);
    std::printf(
        "rendered epipremnum, raw pair | leaves: %zu points, median depth error %.2f mm, %.1f %% within 10 mm | "
        "all within %.0f to %.0f mm: %zu points, %.2f mm, %.1f %%\n",
        leaves.mm.size(), leaves.median(), leaves.within_percent(10), kNearMm, kFarMm, all.mm.size(), all.median(),
        all.within_percent(10));
    EXPECT_LE(leaves.median(), 2.0);
    EXPECT_LE(all.median(), 3.0);
    EXPECT_GE(leaves.within_percent(10), 90);
}

} // namespace
} // namespace dicot
