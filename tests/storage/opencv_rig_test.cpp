// OpenCV's own FileStorage at the other end of the rig file.
#include "temp_folder.h"

#include "dicot/rig/opencv_files.h"
#include "dicot/rig/rig_file.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <cmath>
#include <cstring>
#include <random>
#include <string>

namespace dicot {
namespace {

using test::TempFolder;

/// A number of any size, 53 bits long.
double any(std::mt19937& random)
{
    const double mantissa = static_cast<double>(random()) + static_cast<double>(random()) / 4294967296.0;
    return (random() % 2 == 0 ? mantissa : -mantissa) * std::ldexp(1.0, static_cast<int>(random() % 80) - 60);
}

template <std::size_t Rows, std::size_t Columns>
void fill(std::optional<Matrix<Rows, Columns>>& matrix, std::mt19937& random)
{
    for (auto& row : matrix.emplace())
        for (double& value : row)
            value = any(random);
}

RigFile full_rig(std::mt19937& random)
{
    RigFile rig;
    std::strcpy(rig.id, "rig-0123456789abcdef");
    std::strcpy(rig.calibrated_at, "2026-03-01T12:00:00Z");
    rig.width = 1280;
    rig.height = 720;
    int count = 5;
    for (RigCamera* camera : {&rig.left, &rig.right}) {
        fill(camera->intrinsic, random);
        fill(camera->rectifying, random);
        fill(camera->projection, random);
        camera->distortion.emplace().count = count;
        for (int i = 0; i < count; ++i)
            camera->distortion->at[static_cast<std::size_t>(i)] = any(random);
        count = 14;
    }
    fill(rig.rotation, random);
    fill(rig.reprojection, random);
    rig.translation_mm = {any(random), any(random), any(random)};
    rig.near_mm = 300.1;
    rig.far_mm = 1200;
    rig.quality = RigQuality{"good", 13, 1.0 / 3, 0.1, 0.2, 0.3, 1, {0.5, 1.0 / 7, 1}, 400.25, 1100};
    return rig;
}

template <std::size_t Rows, std::size_t Columns>
void expect_equal(const cv::FileStorage& file, const char* key, const std::optional<Matrix<Rows, Columns>>& ours)
{
    const cv::Mat theirs = file[key].mat();
    ASSERT_EQ(theirs.rows, static_cast<int>(Rows)) << key;
    ASSERT_EQ(theirs.cols, static_cast<int>(Columns)) << key;
    ASSERT_EQ(theirs.type(), CV_64F) << key;
    for (int i = 0; i < theirs.rows; ++i)
        for (int j = 0; j < theirs.cols; ++j)
            EXPECT_EQ(theirs.at<double>(i, j), (*ours)[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)])
                << key << " " << i << " " << j;
}

TEST(OpenCvOpens, ARigFileWithEveryKey)
{
    std::mt19937 random(7);
    const RigFile rig = full_rig(random);
    const TempFolder folder;
    ASSERT_TRUE(write_rig_file(folder.path("rig.yaml").c_str(), rig).ok());

    const cv::FileStorage file(folder.path("rig.yaml"), cv::FileStorage::READ);
    ASSERT_TRUE(file.isOpened());
    expect_equal(file, "K1", rig.left.intrinsic);
    expect_equal(file, "K2", rig.right.intrinsic);
    expect_equal(file, "R", rig.rotation);
    expect_equal(file, "R1", rig.left.rectifying);
    expect_equal(file, "R2", rig.right.rectifying);
    expect_equal(file, "P1", rig.left.projection);
    expect_equal(file, "P2", rig.right.projection);
    expect_equal(file, "Q", rig.reprojection);
    for (const auto& [key, camera] : {std::pair{"D1", &rig.left}, {"D2", &rig.right}}) {
        const cv::Mat theirs = file[key].mat();
        ASSERT_EQ(static_cast<int>(theirs.total()), camera->distortion->count);
        for (int i = 0; i < camera->distortion->count; ++i)
            EXPECT_EQ(theirs.at<double>(i), camera->distortion->at[static_cast<std::size_t>(i)]) << key << i;
    }
    const cv::Mat shift = file["T"].mat();
    ASSERT_EQ(shift.size(), cv::Size(1, 3));
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(shift.at<double>(i), (*rig.translation_mm)[static_cast<std::size_t>(i)]);

    EXPECT_EQ(file["id"].string(), rig.id);
    EXPECT_EQ(file["calibration_time"].string(), rig.calibrated_at);
    EXPECT_EQ(file["unit"].string(), "mm");
    EXPECT_EQ(static_cast<int>(file["image_width"]), 1280);
    EXPECT_EQ(static_cast<int>(file["image_height"]), 720);
    EXPECT_EQ(file["near_mm"].real(), 300.1);
    const cv::FileNode quality = file["quality"];
    ASSERT_TRUE(quality.isMap());
    EXPECT_EQ(quality["verdict"].string(), "good");
    EXPECT_EQ(static_cast<int>(quality["pairs"]), 13);
    EXPECT_EQ(quality["rms_px"].real(), 1.0 / 3);
    EXPECT_EQ(quality["depth_error_at_800mm_mm"].real(), 1.0 / 7);
    EXPECT_EQ(quality["farthest_mm"].real(), 1100);
}

TEST(OpenCvWrites, ARigFileThatIsReadToTheLastBit)
{
    std::mt19937 random(11);
    const TempFolder folder;
    const std::string path = folder.path("cv.yaml");
    cv::Mat k(3, 3, CV_64F), d(1, 8, CV_64F), r(3, 3, CV_64F), t(3, 1, CV_64F), q(4, 4, CV_64F);
    for (cv::Mat* matrix : {&k, &d, &r, &t, &q})
        for (int i = 0; i < static_cast<int>(matrix->total()); ++i)
            matrix->ptr<double>()[i] = any(random);
    {
        cv::FileStorage file(path, cv::FileStorage::WRITE);
        file << "imageSize" << cv::Size(640, 480) << "id"
             << "bench-2"
             << "calibration_time"
             << "Sun Oct 11 17:02:00 2009";
        file << "K1" << k << "D1" << d << "K2" << k.t() << "D2" << d << "R" << r << "T" << t << "Q" << q;
        file << "views"
             << "[" << 1 << 2.5 << "three"
             << "]"
             << "E" << r << "flags" << 2;
    }
    const Result<RigFile> read = read_rig_file(path.c_str());
    ASSERT_TRUE(read.ok()) << read.status().message();
    const RigFile& rig = read.value();
    EXPECT_EQ(rig.width, 640);
    EXPECT_EQ(rig.height, 480);
    EXPECT_STREQ(rig.id, "bench-2");
    const cv::FileStorage file(path,
                               cv::FileStorage::READ); // FileStorage prints 17 digits: the numbers it prints count
    expect_equal(file, "K1", rig.left.intrinsic);
    expect_equal(file, "K2", rig.right.intrinsic);
    expect_equal(file, "R", rig.rotation);
    expect_equal(file, "Q", rig.reprojection);
    for (int i = 0; i < 8; ++i)
        EXPECT_EQ(rig.left.distortion->at[static_cast<std::size_t>(i)], d.at<double>(i));
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ((*rig.translation_mm)[static_cast<std::size_t>(i)], t.at<double>(i));
}

TEST(OpenCvWrites, NotANumberIsRefusedByItsKey)
{
    const TempFolder folder;
    const std::string path = folder.path("cv.yaml");
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        cv::Mat k = cv::Mat::eye(3, 3, CV_64F);
        k.at<double>(1, 2) = bad;
        {
            cv::FileStorage file(path, cv::FileStorage::WRITE);
            file << "image_width" << 640 << "image_height" << 480 << "K2" << k;
        }
        const Result<RigFile> read = read_rig_file(path.c_str());
        EXPECT_EQ(read.status().fault(), Fault::kBadData) << bad;
        EXPECT_NE(std::strstr(read.status().message(), "K2 must be finite"), nullptr) << read.status().message();
    }
}

/// As samples/cpp/stereo_calib.cpp does it: two files, no size, lengths in squares.
TEST(OpenCvWrites, TheFilesOfStereoCalib)
{
    const TempFolder folder;
    const cv::Mat k = (cv::Mat_<double>(3, 3) << 534, 0, 342, 0, 534, 234, 0, 0, 1);
    const cv::Mat d = cv::Mat::zeros(1, 14, CV_64F), r = cv::Mat::eye(3, 3, CV_64F);
    const cv::Mat t = (cv::Mat_<double>(3, 1) << -3.3, 0.04, -0.01);
    const cv::Mat p1 = (cv::Mat_<double>(3, 4) << 530, 0, 340, 0, 0, 530, 240, 0, 0, 0, 1, 0);
    const cv::Mat p2 = (cv::Mat_<double>(3, 4) << 530, 0, 340, -1749, 0, 530, 240, 0, 0, 0, 1, 0);
    cv::Mat q = cv::Mat::eye(4, 4, CV_64F);
    q.at<double>(3, 2) = 1 / 3.3;
    {
        cv::FileStorage inner(folder.path("intrinsics.yml"), cv::FileStorage::WRITE);
        inner << "M1" << k << "D1" << d << "M2" << k << "D2" << d;
        cv::FileStorage outer(folder.path("extrinsics.yml"), cv::FileStorage::WRITE);
        outer << "R" << r << "T" << t << "R1" << r << "R2" << r << "P1" << p1 << "P2" << p2 << "Q" << q;
    }
    ASSERT_TRUE(holds_opencv_files(folder.path(".")));
    const Result<RigFile> read = read_opencv_files(folder.path("."), {640, 480, 30});
    ASSERT_TRUE(read.ok()) << read.status().message();
    const RigFile& rig = read.value();
    EXPECT_EQ(rig.width, 640);
    EXPECT_EQ((*rig.right.intrinsic)[1][2], 234);
    EXPECT_EQ(rig.left.distortion->count, 14);
    EXPECT_DOUBLE_EQ((*rig.translation_mm)[0], -99);
    EXPECT_DOUBLE_EQ(geometry_of(rig, "sample").value().baseline_mm, 99);
    EXPECT_DOUBLE_EQ((*rig.reprojection)[3][2], 1 / 99.0);
    EXPECT_EQ(read_opencv_files(folder.path("."), {}).status().fault(), Fault::kBadData);
}

} // namespace
} // namespace dicot
