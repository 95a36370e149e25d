// The program itself: a pair in, a cloud out.
#include "ply_points.h"
#include "temp_folder.h"
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace dicot {
namespace {

using test::Bytes;
using test::TempFolder;
using test::ToolRun;

constexpr int kWidth = 200;
constexpr int kHeight = 90;
constexpr int kDisparity = 20; // of a wall at f B / d = 500 * 60 / 20 = 1500 mm

ToolRun dicot(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " " + words);
}

std::string rig_text(int width, const std::string& extra)
{
    const std::string projection = "   rows: 3\n   cols: 4\n   dt: d\n   data: [ 500., 0., 100., ";
    const std::string rest = ", 0., 500., 45., 0., 0., 0., 1., 0. ]\n";
    return "%YAML:1.0\n---\nimage_width: " + std::to_string(width) + "\nimage_height: 90\nid: wall\n" + extra +
           "P1: !!opencv-matrix\n" + projection + "0." + rest + "P2: !!opencv-matrix\n" + projection + "-30000." + rest;
}

Bytes ppm(int width, const std::vector<std::uint8_t>& rgb)
{
    const std::string head = "P6 " + std::to_string(width) + " " + std::to_string(kHeight) + " 255\n";
    Bytes bytes(head.begin(), head.end());
    bytes.insert(bytes.end(), rgb.begin(), rgb.end());
    return bytes;
}

/// A textured wall at 1500 mm, seen by both cameras, with its rig file.
struct Wall
{
    TempFolder folder;
    std::string left, right, rig;

    Wall()
    {
        std::mt19937 random{4};
        std::vector<std::uint8_t> texture(static_cast<std::size_t>((kWidth + kDisparity) * kHeight * 3));
        for (std::uint8_t& value : texture)
            value = static_cast<std::uint8_t>(random());
        const auto view = [&](int shift) {
            std::vector<std::uint8_t> rgb;
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x)
                    for (int c = 0; c < 3; ++c)
                        rgb.push_back(
                            texture[static_cast<std::size_t>((y * (kWidth + kDisparity) + x + shift) * 3 + c)]);
            return ppm(kWidth, rgb);
        };
        left = folder.write("left.ppm", view(0));
        right = folder.write("right.ppm", view(kDisparity));
        rig = folder.write("rig.yaml", rig_text(kWidth, "near_mm: 1000\nfar_mm: 3000\n"));
    }
    std::string pair() const { return left + " " + right; }
    std::string words(const std::string& output) const
    {
        return "process " + pair() + " --rig " + rig + " -o " + folder.path(output);
    }
};

TEST(Process, AWallStandsWhereTheGeometrySaysItStands)
{
    const Wall wall;
    const ToolRun run = dicot(wall.words("cloud.drc") + " --ply " + wall.folder.path("cloud.ply") + " --json");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto report = nlohmann::json::parse(run.output);
    EXPECT_EQ(report["min_disparity_px"], 10);
    EXPECT_EQ(report["disparities"], 21);
    const auto vertices = test::ply_points_mm(wall.folder.path("cloud.ply"));
    EXPECT_EQ(report["points"], vertices.size());
    EXPECT_EQ(report["proof"]["points"], vertices.size());
    EXPECT_LT(report["proof"]["worst_error_um"], 1.0);
    // All but the strip that only the left camera sees, and what a check refused.
    EXPECT_GT(vertices.size(), 0.9 * (kWidth - kDisparity) * kHeight);
    std::size_t in_place = 0;
    double right_end = -1e9;
    for (const auto& [x, y, z] : vertices) {
        in_place += std::fabs(z - 1500) < 8 ? 1 : 0; // a tenth of a pixel is 7.5 mm
        right_end = std::max(right_end, x);
    }
    // Beside the strip a few pixels find a partner by chance.
    EXPECT_GT(static_cast<double>(in_place), 0.96 * static_cast<double>(vertices.size()));
    EXPECT_NEAR(right_end, (kWidth - 1 - 100) * 1500.0 / 500, 8.0);
}

TEST(Process, SameBytesOnAnyThreadsAndAnyCpu)
{
    const Wall wall;
    ASSERT_EQ(dicot(wall.words("one.drc") + " --threads 1 --cpu scalar").exit_code, 0);
    ASSERT_EQ(dicot(wall.words("two.drc") + " --threads 3").exit_code, 0);
    EXPECT_EQ(test::bytes_of(wall.folder.path("one.drc")), test::bytes_of(wall.folder.path("two.drc")));
}

TEST(Process, PicturesOfTheResultArePictures)
{
    const Wall wall;
    const ToolRun run = dicot(wall.words("cloud.drc") + " --preview " + wall.folder.path("view.png") + " --disparity " +
                              wall.folder.path("disparity.png"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto view = nlohmann::json::parse(dicot("info --json " + wall.folder.path("view.png")).output);
    EXPECT_EQ(view["kind"], "picture");
    EXPECT_EQ(view["width"], 1280);
    const auto disparity = nlohmann::json::parse(dicot("info --json " + wall.folder.path("disparity.png")).output);
    EXPECT_EQ(disparity["width"], kWidth);
    EXPECT_EQ(disparity["height"], kHeight);
}

/// Two PLYs of one cloud, before and after it was stored: header and places are the same bytes, colours within 2 and
/// confidences within 8 of 255.
void expect_same_vertices(const test::Bytes& direct, const test::Bytes& exported, std::size_t points)
{
    constexpr std::size_t kVertexBytes = 19; // float x, y, z; uchar red, green, blue; float confidence
    constexpr std::size_t kPlaceBytes = 12;
    const std::size_t header = direct.size() - points * kVertexBytes;
    ASSERT_EQ(std::memcmp(direct.data(), exported.data(), header), 0);
    for (std::size_t at = header; at < direct.size(); at += kVertexBytes) {
        ASSERT_EQ(std::memcmp(&direct[at], &exported[at], kPlaceBytes), 0);
        for (std::size_t channel = at + kPlaceBytes; channel < at + 15; ++channel)
            ASSERT_LE(std::abs(direct[channel] - exported[channel]), 2);
        float confidence[2];
        std::memcpy(&confidence[0], &direct[at + 15], sizeof(float));
        std::memcpy(&confidence[1], &exported[at + 15], sizeof(float));
        ASSERT_NEAR(static_cast<double>(confidence[0]), static_cast<double>(confidence[1]), 8.001 / 255);
    }
}

TEST(Process, InfoAndExportTellTheSameCloud)
{
    const Wall wall;
    const std::string drc = wall.folder.path("cloud.drc");
    ASSERT_EQ(dicot(wall.words("cloud.drc") + " --ply " + wall.folder.path("direct.ply")).exit_code, 0);
    const auto info = nlohmann::json::parse(dicot("info --json " + drc).output);
    EXPECT_EQ(info["kind"], "cloud");
    EXPECT_EQ(info["meta"]["calibration_id"], "wall");
    EXPECT_EQ(info["meta"]["near_mm"], 1000);
    EXPECT_EQ(info["meta"]["unit"], "m");
    EXPECT_EQ(info["bytes"], std::filesystem::file_size(drc));
    ASSERT_EQ(dicot("export " + drc + " -o " + wall.folder.path("exported.ply")).exit_code, 0);
    const test::Bytes direct = test::bytes_of(wall.folder.path("direct.ply"));
    const test::Bytes exported = test::bytes_of(wall.folder.path("exported.ply"));
    const auto points = info["points"].get<std::size_t>();
    ASSERT_EQ(direct.size(), exported.size());
    expect_same_vertices(direct, exported, points);
    EXPECT_DOUBLE_EQ(info["times_smaller_than_ply"].get<double>(),
                     19.0 * static_cast<double>(points) / static_cast<double>(std::filesystem::file_size(drc)));
    ASSERT_EQ(dicot("export " + drc + " -o " + wall.folder.path("exported.pcd")).exit_code, 0);
    const auto rig = nlohmann::json::parse(dicot("info --json " + wall.rig).output);
    EXPECT_EQ(rig["kind"], "rig");
    EXPECT_EQ(rig["baseline_mm"], 60);
    EXPECT_EQ(rig["rectified"], true);
}

TEST(Process, TheRangeOfTheCommandLineGoesBeforeTheRigs)
{
    const Wall wall;
    const ToolRun run = dicot(wall.words("cloud.drc") + " --json --near-mm 1200 --far-mm 2000");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_EQ(nlohmann::json::parse(run.output)["near_mm"], 1200);
    EXPECT_EQ(nlohmann::json::parse(run.output)["min_disparity_px"], 15);
}

/// Runs and expects one sentence with `says` and nothing new in the folder.
void expect_refused(const Wall& wall, const std::string& words, int exit_code, const std::string& says)
{
    const std::size_t files = wall.folder.files();
    const ToolRun run = dicot(words);
    EXPECT_EQ(run.exit_code, exit_code) << words << "\n" << run.output;
    EXPECT_NE(run.output.find(says), std::string::npos) << words << "\n" << run.output;
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    EXPECT_EQ(wall.folder.files(), files) << words;
}

TEST(Process, BadInputIsOneSentenceAndLeavesNothing)
{
    const Wall wall;
    const TempFolder& folder = wall.folder;
    const std::string to = " -o " + folder.path("cloud.drc");
    const std::string with_rig = " --rig " + wall.rig + to;
    expect_refused(wall, "process " + folder.path("gone.png") + " " + wall.right + with_rig, 66, "gone.png");
    expect_refused(wall, "process " + wall.pair() + " --rig " + folder.path("gone.yaml") + to, 66, "gone.yaml");
    expect_refused(wall, "process " + wall.rig + " " + wall.right + with_rig, 65, "rig.yaml");
    expect_refused(wall, "process " + wall.pair() + " --rig " + wall.left + to, 65, "left.ppm");
    const std::string other = folder.write("other.yaml", rig_text(400, "near_mm: 1000\nfar_mm: 3000\n"));
    expect_refused(wall, "process " + wall.pair() + " --rig " + other + to, 65, "400 x 90");
    const std::string narrow = folder.write("narrow.ppm", ppm(100, std::vector<std::uint8_t>(100 * kHeight * 3)));
    expect_refused(wall, "process " + wall.left + " " + narrow + with_rig, 65, "narrow.ppm is 100 x 90");
    const std::string unlimited = folder.write("unlimited.yaml", rig_text(kWidth, ""));
    expect_refused(wall, "process " + wall.pair() + " --rig " + unlimited + to, 64, "--near-mm");
    expect_refused(wall, "process " + wall.pair() + with_rig + " --near-mm 100", 64, "--near-mm");
    expect_refused(wall, "process " + wall.pair() + with_rig + " --near-mm 3000 --far-mm 2000", 64, "makes no sense");
    expect_refused(wall, "process " + wall.pair() + " --rig " + wall.rig + " -o " + folder.path("cloud.ply"), 64,
                   ".drc");
    expect_refused(wall, "process " + wall.pair() + " --rig " + wall.rig + " -o /nowhere/at/all/cloud.drc", 73,
                   "/nowhere/at/all");
    expect_refused(wall, wall.words("cloud.drc") + " --preview /nowhere/at/all/view.png", 73, "view.png");
    expect_refused(wall, "export " + wall.left + " -o " + folder.path("cloud.ply"), 65, "not a cloud file");
    expect_refused(wall, "export " + folder.path("gone.drc") + " -o " + folder.path("cloud.ply"), 66, "gone.drc");
    expect_refused(wall, "export " + folder.path("gone.drc") + " -o " + folder.path("cloud.obj"), 64, ".ply or .pcd");
    expect_refused(wall, "info " + folder.path("gone.drc"), 66, "gone.drc");
    expect_refused(wall, "info " + folder.write("empty", Bytes{}), 65, "neither a cloud");
}

TEST(Process, AFullDiskIsNamedAndNothingIsLeft)
{
    const Wall wall;
    std::filesystem::create_symlink("/dev/full", wall.folder.path("full.drc"));
    expect_refused(wall, wall.words("full.drc"), 74, "disk is full");
}

TEST(Process, ACloudWithoutPointsIsRefused)
{
    // The wall at 1500 mm lies before the range, and the next whole disparity, 1578.9 mm, behind it.
    const Wall wall;
    expect_refused(wall, wall.words("cloud.drc") + " --near-mm 1510 --far-mm 1540", 65, "the cloud has no points");
}

TEST(Process, TheAloePairBecomesACloudThatDracoOpens)
{
    const std::string aloe = std::string{DICOT_DATA_DIR} + "/plants/aloe-third/";
    if (!std::filesystem::exists(aloe + "left.png")) {
        std::printf("NOT RUN: %s is not there\n", aloe.c_str());
        return;
    }
    DICOT_NEED_TOOL("draco_decoder", "draco");
    const TempFolder folder;
    const std::string drc = folder.path("aloe.drc");
    const ToolRun run = dicot("process " + aloe + "left.png " + aloe + "right.png --rig " + DICOT_TEST_DATA +
                              "/aloe-third.yaml -o " + drc + " --json");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto report = nlohmann::json::parse(run.output);
    std::printf("%d points, %.1f bits a point, encode and verify %.3f s\n", report["points"].get<int>(),
                report["bits_per_point"].get<double>(), report["stages_s"]["encode"].get<double>());
    EXPECT_GT(report["points"], 120000);
    EXPECT_LT(report["bits_per_point"], 30);
    const ToolRun decoded = test::run("draco_decoder -i " + drc + " -o " + folder.path("aloe.ply"));
    ASSERT_EQ(decoded.exit_code, 0) << decoded.output;
    EXPECT_GT(std::filesystem::file_size(folder.path("aloe.ply")), report["points"].get<std::uintmax_t>() * 15);
}

} // namespace
} // namespace dicot
