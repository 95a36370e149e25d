#include "dicot/calibration/camera.h"
#include "dicot/calibration/quality.h"

#include "rig_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dicot::calibration {
namespace {

using test::turn_about;
using test::webcam_rig;

const Board kBoard{9, 7, 35};

/// Depth by `rig` of what the true rig sees at `distance_mm`, over a grid of directions: root mean squared error.
double true_depth_error_mm(const StereoRig& truth, const StereoRig& rig, double distance_mm)
{
    double squares = 0;
    int count = 0;
    for (double x = -0.7; x < 0.8; x += 0.1)
        for (double y = -0.4; y < 0.45; y += 0.1) {
            const Point3 p{x * distance_mm, y * distance_mm, distance_mm};
            const Point2 l = test::reference_project(truth.left, p);
            const Point2 r = test::reference_project(truth.right, truth.into_right(p));
            if (l.x < 0 || l.x > 1279 || l.y < 0 || l.y > 719 || r.x < 0 || r.x > 1279 || r.y < 0 || r.y > 719)
                continue;
            const auto at = triangulate(rig, undistort(rig.left, l).value(), undistort(rig.right, r).value());
            squares += (at->z - distance_mm) * (at->z - distance_mm);
            ++count;
        }
    return std::sqrt(squares / count);
}

TEST(PredictDepthError, AgreesWithTheSpreadOfManyCalibrations)
{
    const StereoRig truth = webcam_rig();
    constexpr int kRuns = 25;
    for (const double distance_mm : {500.0, 800.0, 1000.0}) {
        double squares = 0;
        double predicted = 0;
        for (std::uint32_t run = 0; run < kRuns; ++run) {
            const auto solved = solve_stereo(test::varied_task(truth, kBoard, 10, 0.1, 200 + run));
            ASSERT_TRUE(solved.ok()) << solved.status().message();
            const double error = true_depth_error_mm(truth, solved.value().rig, distance_mm);
            squares += error * error / kRuns;
            const double prediction = predict_depth_error(solved.value(), distance_mm).calibration_mm;
            predicted += prediction * prediction / kRuns;
        }
        const double ratio = std::sqrt(squares / predicted);
        std::printf("%4.0f mm: depth off by %.3f mm, predicted %.3f mm\n", distance_mm, std::sqrt(squares),
                    std::sqrt(predicted));
        EXPECT_GT(ratio, 0.6) << distance_mm;
        EXPECT_LT(ratio, 1.6) << distance_mm;
    }
}

TEST(PredictDepthError, AddsTheNoiseOfACornerByTheDepthFormula)
{
    StereoCalibration c;
    c.rig = webcam_rig();
    c.rig.left = c.rig.right = {800, 800, 639.5, 359.5, {}};
    c.rig.turn = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    c.rig.shift_mm = {-80, 0, 0};
    c.sigma_px = 0.1;
    const DepthError error = predict_depth_error(c, 800);
    EXPECT_EQ(error.calibration_mm, 0);
    EXPECT_NEAR(error.corner_mm, 800.0 * 800.0 / (800 * 80) * 0.1 * std::sqrt(2.0), 0.005); // Z^2 / (f B) sigma
}

TEST(Assess, CallsAVariedSetGoodAndMeasuresItsNoise)
{
    const CalibrationTask task = test::varied_task(webcam_rig(), kBoard, 18, 0.08, 21);
    const auto solved = solve_stereo(task);
    ASSERT_TRUE(solved.ok());
    const Quality q = assess(task, solved.value(), {400, 1300});
    EXPECT_EQ(q.verdict, Verdict::kGood) << (q.advice.empty() ? "" : q.advice.front());
    EXPECT_TRUE(q.advice.empty());
    EXPECT_EQ(q.held_out_pairs, 18);
    // Both pictures bring their noise across the rows.
    EXPECT_NEAR(q.epipolar_rms_px, 0.08 * std::sqrt(2.0), 0.02);
    EXPECT_NEAR(q.epipolar_p95_px, 1.96 * q.epipolar_rms_px, 0.02);
    EXPECT_GT(q.nearest_mm, 300);
    EXPECT_LT(q.farthest_mm, 1400);
    EXPECT_GT(q.left.share, 0.8);
}

TEST(Assess, SeesAWrongAngleThatEpipolarLinesDoNotShow)
{
    // Field sickness: 0.1 degrees of yaw after the calibration leave the rows aligned and bend depth by percents.
    const StereoRig truth = webcam_rig();
    const CalibrationTask task = test::varied_task(truth, kBoard, 12, 0.02, 22);
    auto solved = solve_stereo(task);
    ASSERT_TRUE(solved.ok());
    StereoCalibration yawed = solved.value();
    yawed.rig.turn = test::times(turn_about(0, 0.1, 0), yawed.rig.turn);
    double straight = 0;
    double bent = 0;
    for (const View& view : task.views)
        for (std::size_t k = 0; k < view.left.size(); ++k) {
            straight = std::max(straight, *epipolar_distance_px(solved.value().rig, view.left[k], view.right[k]));
            bent = std::max(bent, *epipolar_distance_px(yawed.rig, view.left[k], view.right[k]));
        }
    EXPECT_LT(bent, straight + 0.6);
    EXPECT_GT(true_depth_error_mm(truth, yawed.rig, 800), 10);
    EXPECT_LT(true_depth_error_mm(truth, solved.value().rig, 800), 1);
}

TEST(Assess, SaysWhatIsMissing)
{
    // Six boards in the left part of the picture, all near.
    const StereoRig rig = webcam_rig();
    std::mt19937 random(31);
    CalibrationTask task = test::varied_task(rig, kBoard, 0, 0, 1);
    for (int k = 0; k < 6; ++k)
        task.views.push_back(test::view_of(
            rig, {9, 7, 18}, 0,
            {turn_about(k % 2 == 0 ? 30 : -30, k < 3 ? 25 : -25, 4), {-60.0 - 20 * k, -30.0 + 20 * k, 420.0 + 10 * k}},
            0.15, random));
    task.boards[0].square_mm = 18;
    const auto solved = solve_stereo(task);
    ASSERT_TRUE(solved.ok()) << solved.status().message();
    const Quality q = assess(task, solved.value(), {400, 1200});
    EXPECT_NE(q.verdict, Verdict::kGood);
    std::string advice;
    for (const std::string& line : q.advice)
        advice += line + "\n";
    EXPECT_THAT(advice, testing::HasSubstr("6 pairs were used"));
    EXPECT_THAT(advice, testing::HasSubstr("show the board in its"));
    EXPECT_THAT(advice, testing::HasSubstr("right"));
    EXPECT_THAT(advice, testing::HasSubstr("no board stood in the far third"));
}

} // namespace
} // namespace dicot::calibration
