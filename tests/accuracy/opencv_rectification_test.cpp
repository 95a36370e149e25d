// Lenses, rectification and maps as OpenCV computes them for the same cameras.
#include "calibration_data.h"
#include "opencv_words.h"
#include "rig_scene.h"
#include "temp_folder.h"

#include "dicot/rectification/lens_map.h"
#include "dicot/rectification/rectify.h"
#include "dicot/rig/ros_files.h"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include <cmath>
#include <random>

namespace dicot {
namespace {

using test::camera_matrix;
using test::coefficients;
using test::column_of;
using test::largest_difference;
using test::matrix_of;

struct NamedRig
{
    const char* name;
    StereoRig rig;
};

/// The cameras of OpenCV's 13 real pairs (as solved from them, algo/calibration/README.md), those that rendered rig-dev
/// (its README), and a pair of webcams with more distortion.
std::vector<NamedRig> rigs()
{
    StereoRig real;
    real.width = 640;
    real.height = 480;
    real.left = {533.56, 533.60, 342.53, 234.77, {-0.2884, 0.0971, 0.0011, -0.0003, 0}};
    real.right = {536.89, 536.48, 327.40, 249.95, {-0.2894, 0.1069, -0.0006, 0.0001, 0}};
    real.turn = test::turn_about(0.41, 0.245, -0.2);
    real.shift_mm = {-99.81, 1.10, -0.14};
    StereoRig rendered;
    rendered.width = 1280;
    rendered.height = 720;
    rendered.left = {777.893, 779.228, 638.209, 359.949, {-0.10451, 0.03958, 0.000647, -0.000971, 0}};
    rendered.right = {783.055, 781.847, 649.955, 358.405, {-0.14228, 0.02830, 0.001375, -0.001178, 0}};
    rendered.turn = test::turn_about(-1.177, 0.467, -1.068);
    rendered.shift_mm = {-84.985, 0.9, 1.3};
    return {{"real pairs", real}, {"rig-dev", rendered}, {"webcams", test::webcam_rig()}};
}

struct CvRectification
{
    cv::Mat r1, r2, p1, p2, q;
};

CvRectification rectified_by_opencv(const StereoRig& rig, double alpha)
{
    CvRectification flat;
    cv::stereoRectify(camera_matrix(rig.left), coefficients(rig.left), camera_matrix(rig.right),
                      coefficients(rig.right), {rig.width, rig.height}, matrix_of(rig.turn), column_of(rig.shift_mm),
                      flat.r1, flat.r2, flat.p1, flat.p2, flat.q, cv::CALIB_ZERO_DISPARITY, alpha);
    return flat;
}

TEST(BesideOpenCv, RectifyingRotationsAndBaselineAreTheSame)
{
    std::printf("%-11s %5s | R1, R2 apart by | focal ours, OpenCV px     | centre ours, OpenCV px              | "
                "baseline apart by\n",
                "stereoRect.", "alpha");
    for (const auto& [name, rig] : rigs())
        for (const double alpha : {kCrop, kKeepAll}) {
            const Rectification ours = rectify(rig, alpha, name).value();
            const CvRectification theirs = rectified_by_opencv(rig, alpha);
            const double turns = std::max(largest_difference(theirs.r1, matrix_of(ours.left_rectifying)),
                                          largest_difference(theirs.r2, matrix_of(ours.right_rectifying)));
            const double focal = theirs.p1.at<double>(0, 0), cx = theirs.p1.at<double>(0, 2),
                         cy = theirs.p1.at<double>(1, 2);
            const double baseline = -theirs.p2.at<double>(0, 3) / focal;
            std::printf("%-11s %5.0f | %15.1e | %10.4f, %10.4f    | %8.3f %8.3f, %8.3f %8.3f | %.1e mm\n", name, alpha,
                        turns, ours.focal_px, focal, ours.cx_px, ours.cy_px, cx, cy,
                        std::fabs(baseline - ours.baseline_mm));
            EXPECT_LT(turns, 1e-9);
            EXPECT_NEAR(ours.baseline_mm, baseline, 1e-9 * baseline);
            // The pictures' borders decide the focal length: OpenCV looks at 9 points of each side, in floats.
            EXPECT_NEAR(ours.focal_px, focal, 0.002 * focal);
            EXPECT_NEAR(ours.cx_px, cx, 0.02);
            EXPECT_NEAR(ours.cy_px, cy, 0.02);
        }
}

template <std::size_t Rows, std::size_t Columns>
Matrix<Rows, Columns> values_of(const cv::Mat& from)
{
    Matrix<Rows, Columns> values{};
    for (std::size_t i = 0; i < Rows * Columns; ++i)
        values[i / Columns][i % Columns] =
            from.at<double>(static_cast<int>(i / Columns), static_cast<int>(i % Columns));
    return values;
}

TEST(BesideOpenCv, ItsRigsGoThroughCameraInfoAndComeBackWithItsQ)
{
    for (const auto& [name, rig] : rigs()) {
        const CvRectification flat = rectified_by_opencv(rig, 0);
        RigFile file;
        file.width = rig.width;
        file.height = rig.height;
        file.left = {values_of<3, 3>(camera_matrix(rig.left)), Distortion{}, values_of<3, 3>(flat.r1),
                     values_of<3, 4>(flat.p1)};
        file.right = {values_of<3, 3>(camera_matrix(rig.right)), Distortion{}, values_of<3, 3>(flat.r2),
                      values_of<3, 4>(flat.p2)};
        file.rotation = values_of<3, 3>(matrix_of(rig.turn));
        file.translation_mm = {rig.shift_mm.x, rig.shift_mm.y, rig.shift_mm.z};
        const test::TempFolder folder;
        const Status written = write_ros_files(file, folder.path("."), name);
        ASSERT_TRUE(written.ok()) << written.message();
        const Matrix<4, 4> ours = *read_ros_files(folder.path(".")).value().reprojection;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                const double theirs = flat.q.at<double>(i, j);
                EXPECT_NEAR(ours[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)], theirs,
                            1e-12 * std::fabs(theirs))
                    << name << " " << i << " " << j;
            }
    }
}

TEST(BesideOpenCv, MapsAreTheSameWithin1e3Px)
{
    for (const auto& [name, rig] : rigs()) {
        const CvRectification flat = rectified_by_opencv(rig, 0);
        double worst = 0;
        for (const auto& [lens, turn, projection] :
             {std::tuple{&rig.left, &flat.r1, &flat.p1}, {&rig.right, &flat.r2, &flat.p2}}) {
            cv::Mat map_x, map_y;
            cv::initUndistortRectifyMap(camera_matrix(*lens), coefficients(*lens), *turn, *projection,
                                        {rig.width, rig.height}, CV_32FC1, map_x, map_y);
            const LensMap ours(*lens, test::turn_of(*turn), projection->at<double>(0, 0), projection->at<double>(0, 2),
                               projection->at<double>(1, 2));
            for (int y = 0; y < rig.height; ++y)
                for (int x = 0; x < rig.width; ++x) {
                    const Point2 at = ours.source_of(x, y);
                    worst = std::max({worst, std::fabs(at.x - static_cast<double>(map_x.at<float>(y, x))),
                                      std::fabs(at.y - static_cast<double>(map_y.at<float>(y, x)))});
                }
        }
        std::printf("%s: initUndistortRectifyMap, every pixel of both cameras: %.1e px apart at most\n", name, worst);
        EXPECT_LT(worst, 1e-3);
    }
}

/// A lens with all twelve coefficients, one to one out to a good 60 degrees.
Lens any_lens(std::mt19937& random)
{
    const auto within = [&](double most) { return test::between(-most, most, random); };
    Lens lens{800 + within(50), 805 + within(50), 640 + within(20), 360 + within(20), {}};
    lens.k = {0.05 + within(0.05), 0.01 + within(0.01), within(0.002), within(0.002),
              within(0.005),       0.02 + within(0.02), within(0.005), within(0.002),
              within(0.002),       within(0.001),       within(0.002), within(0.001)};
    return lens;
}

TEST(BesideOpenCv, AllTwelveCoefficientsBendRaysTheSameWay)
{
    std::mt19937 random(3);
    double project_px = 0, undistort_px = 0;
    for (int round = 0; round < 40; ++round) {
        const Lens lens = any_lens(random);
        std::vector<cv::Point3d> points;
        for (int i = 0; i < 200; ++i)
            points.emplace_back(test::between(-500, 500, random), test::between(-400, 400, random),
                                test::between(600, 1500, random));
        std::vector<cv::Point2d> pixels, directions;
        cv::projectPoints(points, cv::Mat::zeros(3, 1, CV_64F), cv::Mat::zeros(3, 1, CV_64F), camera_matrix(lens),
                          coefficients(lens), pixels);
        cv::undistortPoints(pixels, directions, camera_matrix(lens), coefficients(lens), cv::noArray(), cv::noArray(),
                            cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 500, 1e-13));
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point2 ours = project(lens, {points[i].x, points[i].y, points[i].z});
            project_px = std::max({project_px, std::fabs(ours.x - pixels[i].x), std::fabs(ours.y - pixels[i].y)});
            const auto back = undistort(lens, {pixels[i].x, pixels[i].y});
            ASSERT_TRUE(back) << "round " << round << ", point " << i;
            undistort_px = std::max({undistort_px, lens.fx * std::fabs(back->x - directions[i].x),
                                     lens.fy * std::fabs(back->y - directions[i].y)});
        }
    }
    std::printf("projectPoints: %.1e px apart at most; undistortPoints: %.1e px\n", project_px, undistort_px);
    EXPECT_LT(project_px, 1e-9);
    EXPECT_LT(undistort_px, 1e-8);
}

} // namespace
} // namespace dicot
