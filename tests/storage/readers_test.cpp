// Real readers, from Debian, open what we write.
#include "cloud_cases.h"
#include "temp_folder.h"
#include "tool.h"

#include "dicot/codec/encode_cloud.h"
#include "dicot/export/export_cloud.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

namespace dicot {
namespace {

const CloudGrid kGrid{100, 14, {-8192, -8192, 3000}};

std::vector<CloudPoint> some_points()
{
    return test::random_points(kGrid, 2000, 21);
}

CloudMeta some_meta()
{
    CloudMeta meta;
    meta.software = "dicot test";
    meta.sequence = 9;
    return meta;
}

/// What a file keeps of a colour's channel: off by so much, of 255.
constexpr int kStored = 2;

/// One vertex as a reader understood it.
struct Vertex
{
    float x, y, z;
    int r, g, b;
    float confidence;
};

void expect_same(const std::vector<Vertex>& read, const std::vector<CloudPoint>& points, double tolerance_m,
                 bool has_confidence, int colour_tolerance = 0)
{
    ASSERT_EQ(read.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_NEAR(static_cast<double>(read[i].x), points[i].x * 1e-4, tolerance_m) << i;
        ASSERT_NEAR(static_cast<double>(read[i].y), points[i].y * 1e-4, tolerance_m) << i;
        ASSERT_NEAR(static_cast<double>(read[i].z), points[i].z * 1e-4, tolerance_m) << i;
        ASSERT_LE(std::abs(read[i].r - points[i].colour.r), colour_tolerance) << i;
        ASSERT_LE(std::abs(read[i].g - points[i].colour.g), colour_tolerance) << i;
        ASSERT_LE(std::abs(read[i].b - points[i].colour.b), colour_tolerance) << i;
        if (has_confidence) {
            ASSERT_NEAR(static_cast<double>(read[i].confidence), points[i].confidence / 255.0, 1e-6) << i;
        }
    }
}

/// The rows of an ASCII PCD file with the fields x y z rgb confidence, rgb as PCL packs it.
std::vector<Vertex> read_ascii_pcd(const std::string& path)
{
    const test::Bytes bytes = test::bytes_of(path);
    std::istringstream text{std::string{bytes.begin(), bytes.end()}};
    std::string line;
    bool rgb_is_whole = false;
    while (std::getline(text, line) && line != "DATA ascii") {
        if (line.starts_with("FIELDS")) {
            EXPECT_EQ(line, "FIELDS x y z rgb confidence");
        }
        if (line.starts_with("TYPE"))
            rgb_is_whole = line == "TYPE F F F U F";
    }
    std::vector<Vertex> vertices;
    while (std::getline(text, line)) {
        Vertex vertex{};
        std::istringstream fields{line};
        std::string rgb;
        fields >> vertex.x >> vertex.y >> vertex.z >> rgb >> vertex.confidence;
        std::uint32_t packed = 0;
        if (rgb_is_whole) {
            packed = static_cast<std::uint32_t>(std::stoul(rgb));
        } else {
            const float as_float = std::strtof(rgb.c_str(), nullptr); // a denormal: stof would refuse it
            std::memcpy(&packed, &as_float, sizeof packed);
        }
        vertex.r = static_cast<int>(packed >> 16 & 255);
        vertex.g = static_cast<int>(packed >> 8 & 255);
        vertex.b = static_cast<int>(packed & 255);
        vertices.push_back(vertex);
    }
    return vertices;
}

TEST(Readers, DracosDecoderOpensTheCloud)
{
    DICOT_NEED_TOOL("draco_decoder", "draco");
    const test::TempFolder folder;
    const auto points = some_points();
    std::vector<std::byte> heap(encode_heap_bytes(points.size()));
    const EncodedCloud encoded = encode_cloud({points, kGrid}, some_meta(), heap).value();
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(encoded.bytes.data());
    const std::string drc = folder.write("cloud.drc", std::span{bytes, encoded.bytes.size()});
    const std::string ply = folder.path("decoded.ply");
    const test::ToolRun run = test::run("draco_decoder -i " + drc + " -o " + ply);
    ASSERT_EQ(run.exit_code, 0) << run.output;

    const test::Bytes file = test::bytes_of(ply);
    const std::string text{file.begin(), file.end()};
    const std::string end = "end_header\n";
    const std::size_t start = text.find(end);
    ASSERT_NE(start, std::string::npos);
    EXPECT_NE(text.find("format binary_little_endian"), std::string::npos);
    constexpr std::size_t kVertexBytes = 15; // its writer drops the confidence
    ASSERT_EQ(text.size() - start - end.size(), points.size() * kVertexBytes);
    std::vector<Vertex> vertices;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Vertex vertex{};
        const std::uint8_t* at = file.data() + start + end.size() + i * kVertexBytes;
        std::memcpy(&vertex.x, at, 4);
        std::memcpy(&vertex.y, at + 4, 4);
        std::memcpy(&vertex.z, at + 8, 4);
        vertex.r = at[12];
        vertex.g = at[13];
        vertex.b = at[14];
        vertices.push_back(vertex);
    }
    expect_same(vertices, points, 1e-6, false, kStored);
}

TEST(Readers, PclOpensThePly)
{
    DICOT_NEED_TOOL("pcl_ply2pcd", "pcl-tools");
    const test::TempFolder folder;
    const auto points = some_points();
    const std::string ply = folder.path("cloud.ply");
    ASSERT_TRUE(export_cloud(ply.c_str(), {points, kGrid}, some_meta()).ok());
    const std::string pcd = folder.path("from_ply.pcd");
    const test::ToolRun run = test::run("pcl_ply2pcd -format 0 " + ply + " " + pcd);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    expect_same(read_ascii_pcd(pcd), points, 1e-5, true);
}

TEST(Readers, PclOpensThePcd)
{
    DICOT_NEED_TOOL("pcl_convert_pcd_ascii_binary", "pcl-tools");
    const test::TempFolder folder;
    const auto points = some_points();
    const std::string pcd = folder.path("cloud.pcd");
    ASSERT_TRUE(export_cloud(pcd.c_str(), {points, kGrid}, some_meta()).ok());
    const std::string ascii = folder.path("ascii.pcd");
    const test::ToolRun run = test::run("pcl_convert_pcd_ascii_binary " + pcd + " " + ascii + " 0");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    expect_same(read_ascii_pcd(ascii), points, 1e-5, true);
}

TEST(Export, HeadersSayUnitFrameAndSoftware)
{
    const test::TempFolder folder;
    const auto points = some_points();
    for (const char* name : {"cloud.ply", "cloud.pcd"}) {
        const std::string path = folder.path(name);
        ASSERT_TRUE(export_cloud(path.c_str(), {points, kGrid}, some_meta()).ok());
        const test::Bytes file = test::bytes_of(path);
        const std::string text{file.begin(), file.end()};
        for (const char* said :
             {"unit m\n", "frame rectified-left x-right y-down z-forward\n", "software dicot test\n", "sequence 9\n"})
            EXPECT_NE(text.find(said), std::string::npos) << name << ": " << said;
    }
}

TEST(Export, OtherEndingsAndBadPlacesAreRefused)
{
    const auto points = some_points();
    const PointCloud cloud{points, kGrid};
    EXPECT_EQ(export_cloud("cloud.obj", cloud, {}).fault(), Fault::kUsage);
    EXPECT_EQ(export_cloud("/nowhere/at/all/cloud.ply", cloud, {}).fault(), Fault::kCannotCreate);
    EXPECT_EQ(write_ply("/dev/full", cloud, {}).fault(), Fault::kIoError);
    EXPECT_EQ(write_pcd("/dev/full", cloud, {}).fault(), Fault::kIoError);
}

} // namespace
} // namespace dicot
