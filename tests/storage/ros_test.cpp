// camera_info pairs: there and back, and as camera_calibration writes them.
#include "temp_folder.h"

#include "dicot/rig/ros_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace dicot {
namespace {

using test::TempFolder;

/// A product of a turn by `x` about x and by `y` about y, each given as its tangent of half the angle.
Matrix<3, 3> turn(double x, double y)
{
    const double cx = (1 - x * x) / (1 + x * x), sx = 2 * x / (1 + x * x);
    const double cy = (1 - y * y) / (1 + y * y), sy = 2 * y / (1 + y * y);
    return {{{cy, 0, sy}, {sx * sy, cx, -sx * cy}, {-cx * sy, sx, cx * cy}}};
}

/// Rectified cameras that were turned by R1 and R2, 85 mm apart.
RigFile rig_of(const Matrix<3, 3>& r1, const Matrix<3, 3>& r2, double offset_px)
{
    RigFile rig;
    rig.width = 1280;
    rig.height = 720;
    rig.left.intrinsic = {{{777.893, 0, 638.209}, {0, 779.228, 359.949}, {0, 0, 1}}};
    rig.right.intrinsic = {{{783.055, 0, 649.955}, {0, 781.847, 358.405}, {0, 0, 1}}};
    rig.left.distortion = Distortion{5, {-0.10451, 0.03958, 0.000647, -0.000971, 1e-300}};
    rig.right.distortion = Distortion{8, {-0.14228, 0.0283, 0.001375, -0.001178, 0.1, 1e-5, -0.2, 1.0 / 3}};
    rig.left.rectifying = r1;
    rig.right.rectifying = r2;
    const double f = 784.9, baseline = 84.9851542526;
    rig.left.projection = {{{f, 0, 641.3, 0}, {0, f, 360.7, 0}, {0, 0, 1, 0}}};
    rig.right.projection = {{{f, 0, 641.3 + offset_px, -f * baseline}, {0, f, 360.7, 0}, {0, 0, 1, 0}}};
    // x_right = R2^T R1 x_left + R2^T (-baseline, 0, 0)
    rig.rotation.emplace();
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k)
                (*rig.rotation)[i][j] += r2[k][i] * r1[k][j];
    rig.translation_mm = {-baseline * r2[0][0], -baseline * r2[0][1], -baseline * r2[0][2]};
    rig.reprojection = {
        {{1, 0, 0, -641.3}, {0, 1, 0, -360.7}, {0, 0, 0, f}, {0, 0, 1 / baseline, offset_px / baseline}}};
    return rig;
}

template <std::size_t Rows, std::size_t Columns>
void expect_same(const char* key, const std::optional<Matrix<Rows, Columns>>& a,
                 const std::optional<Matrix<Rows, Columns>>& b)
{
    ASSERT_TRUE(a && b) << key;
    double largest = 0;
    for (const auto& row : *a)
        for (const double value : row)
            largest = std::max(largest, std::fabs(value));
    for (std::size_t i = 0; i < Rows; ++i)
        for (std::size_t j = 0; j < Columns; ++j)
            EXPECT_NEAR((*a)[i][j], (*b)[i][j],
                        1e-9 * ((*a)[i][j] == 0 || largest <= 1 ? largest : std::fabs((*a)[i][j])))
                << key << " " << i << " " << j;
}

TEST(RosFiles, EveryMatrixComesBackEqualTo1e9)
{
    for (const double offset_px : {0.0, 12.5}) {
        const RigFile rig = rig_of(turn(0.004, -0.002), turn(-0.006, 0.01), offset_px);
        const TempFolder folder;
        const Status written = write_ros_files(rig, folder.path("."), "rig.yaml");
        ASSERT_TRUE(written.ok()) << written.message();
        const Result<RigFile> read = read_ros_files(folder.path("."));
        ASSERT_TRUE(read.ok()) << read.status().message();
        const RigFile& back = read.value();
        EXPECT_EQ(back.width, 1280);
        EXPECT_EQ(back.height, 720);
        expect_same("K1", rig.left.intrinsic, back.left.intrinsic);
        expect_same("K2", rig.right.intrinsic, back.right.intrinsic);
        expect_same("R1", rig.left.rectifying, back.left.rectifying);
        expect_same("R2", rig.right.rectifying, back.right.rectifying);
        expect_same("P1", rig.left.projection, back.left.projection);
        expect_same("P2", rig.right.projection, back.right.projection);
        expect_same("R", rig.rotation, back.rotation);
        expect_same("Q", rig.reprojection, back.reprojection);
        EXPECT_EQ(rig.left.distortion, back.left.distortion);
        EXPECT_EQ(rig.right.distortion, back.right.distortion);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR((*rig.translation_mm)[i], (*back.translation_mm)[i], 1e-9 * 85);

        // And the other way round: files, rig, files.
        const TempFolder again;
        ASSERT_TRUE(write_ros_files(back, again.path("."), "rig.yaml").ok());
        const RigFile twice = read_ros_files(again.path(".")).value();
        expect_same("R1", back.left.rectifying, twice.left.rectifying);
        expect_same("P2", back.right.projection, twice.right.projection);
        expect_same("R", back.rotation, twice.rotation);
    }
}

const char* const kLeftOfCameraCalibration = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo/left
camera_matrix:
  rows: 3
  cols: 3
  data: [533.56 ,   0.     , 342.53 ,
           0.   , 533.6    , 234.77 ,
           0.   ,   0.     ,   1.     ]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.28838, 9.71e-2, 1.1e-3, -3E-4, 0.000000]
rectification_matrix:
  rows: 3
  cols: 3
  data: [ 0.99988,  0.00714, -0.01367,
         -0.0071 ,  0.99997,  0.00318,
          0.01369, -0.00308,  0.9999 ]
projection_matrix:
  rows: 3
  cols: 4
  data: [ 5.3e+02,   0.     , 330. ,   0.     ,
           0.     , 530.    , 240. ,   0.     ,
           0.     ,   0.     ,   1.     ,   0.     ]
binning_x: 0
roi: {x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false}
)";

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    if (at == std::string::npos)
        throw std::runtime_error(from + " is not in the text");
    return text.replace(at, from.size(), to);
}

const std::string kLeft = kLeftOfCameraCalibration;
const std::string kRight = replaced(
    replaced(replaced(replaced(kLeft, "240. ,   0.     ", "240. ,   0"), "330. ,   0.     ,", "330. , -5.29E+01,"),
             "plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.28838, 9.71e-2, 1.1e-3, -3E-4, "
             "0.000000]",
             "rational_polynomial\ndistortion_coefficients: {rows: 8, cols: 1, data: [-0.2,.1,0,0,0,+1e-3,0,1.]}"),
    "narrow_stereo/left", "narrow_stereo/right");

Result<RigFile> pair(const std::string& left, const std::string& right)
{
    const auto bytes = [](const std::string& text) { return std::as_bytes(std::span{text.data(), text.size()}); };
    return parse_ros(bytes(left), bytes(right), "cams");
}

TEST(RosFiles, OfCameraCalibrationAreUnderstood)
{
    const Result<RigFile> read = pair(kLeft, kRight);
    ASSERT_TRUE(read.ok()) << read.status().message();
    const RigFile& rig = read.value();
    EXPECT_NEAR(geometry_of(rig, "cams").value().baseline_mm, 99.8113, 1e-3);
    EXPECT_EQ(rig.left.distortion->at[1], 0.0971);
    EXPECT_EQ(rig.right.distortion->count, 8);
    EXPECT_EQ(rig.right.distortion->at[5], 1e-3);
    EXPECT_EQ((*rig.left.projection)[0][0], 530);
    const Matrix<3, 3>& r = *rig.left.rectifying;
    EXPECT_NEAR(r[0][0] * r[1][0] + r[0][1] * r[1][1] + r[0][2] * r[1][2], 0, 1e-14)
        << "five decimals, a rotation again";
    EXPECT_NEAR(r[2][0] * r[2][0] + r[2][1] * r[2][1] + r[2][2] * r[2][2], 1, 1e-14);
    EXPECT_NEAR(r[0][2], -0.01367, 2e-5);
}

TEST(RosFiles, RefusalsNameTheFileAndTheReason)
{
    const auto expect = [](const Result<RigFile>& rig, const char* says) {
        ASSERT_FALSE(rig.ok()) << says;
        EXPECT_EQ(rig.status().fault(), Fault::kBadData);
        EXPECT_EQ(std::strncmp(rig.status().message(), "cams", 4), 0) << rig.status().message();
        EXPECT_NE(std::strstr(rig.status().message(), says), nullptr) << rig.status().message();
    };
    expect(pair(kRight, kLeft), "swapped");
    expect(pair(kLeft, kLeft), "swapped");
    expect(pair(replaced(kLeft, "plumb_bob", "equidistant"), kRight),
           "left.yaml: line 10: distortion_model must be plumb");
    expect(pair(kLeft, replaced(kRight, "640", "641")), "right.yaml for 641 x 480");
    expect(pair(kLeft, replaced(kRight, "342.53", ".nan")), "right.yaml: line 7: camera_matrix must be finite");
    expect(pair(kLeft, replaced(kRight, "-5.29E+01", "-1e307")), "too large");
    expect(pair(kLeft, replaced(kRight, "0.99997", "0.9")), "rectification_matrix is no rotation");
    expect(pair(kLeft, replaced(kRight, "projection_matrix", "projektion")), "is missing or senseless");
    expect(pair(kLeft, replaced(kRight, "5.3e+02", "520")), "focal lengths"); // not of one pair
}

TEST(RosFiles, ARigWhoseRectificationIsOfOtherCamerasIsRefused)
{
    RigFile rig = rig_of(turn(0.004, -0.002), turn(-0.006, 0.01), 0);
    (*rig.translation_mm)[1] += 0.01;
    const TempFolder folder;
    const Status status = write_ros_files(rig, folder.path("."), "rig.yaml");
    EXPECT_EQ(status.fault(), Fault::kBadData);
    EXPECT_NE(std::strstr(status.message(), "do not belong to R and T"), nullptr) << status.message();
    EXPECT_EQ(folder.files(), 0U);
}

TEST(RosFiles, AWriteThatFailsLeavesTheFormerPair)
{
    const TempFolder folder;
    folder.write("left.yaml", std::string("former left"));
    std::filesystem::create_symlink("/dev/full", folder.path("right.yaml"));
    const RigFile rig = rig_of(turn(0.004, -0.002), turn(-0.006, 0.01), 0);
    EXPECT_EQ(write_ros_files(rig, folder.path("."), "rig.yaml").fault(), Fault::kIoError);
    EXPECT_EQ(test::bytes_of(folder.path("left.yaml")).size(), std::strlen("former left"));
    EXPECT_EQ(folder.files(), 2U);
}

} // namespace
} // namespace dicot
