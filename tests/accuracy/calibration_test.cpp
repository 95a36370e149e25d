#include "calibration_data.h"
#include "rig_scene.h"

#include "dicot/calibration/camera.h"
#include "dicot/calibration/quality.h"
#include "dicot/os/process_memory.h"

#include <gtest/gtest.h>

#include <ctime>

namespace dicot::calibration {
namespace {

using test::kBoard10;
using test::kBoard8;
using test::kOpenCvPairs;
using test::PairSet;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kInstrumented = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kInstrumented = true;
#else
constexpr bool kInstrumented = false;
#endif
#else
constexpr bool kInstrumented = false;
#endif

void print(const char* name, const StereoCalibration& c, const Quality& q)
{
    std::printf(
        "%s: %d pairs, RMS left %.3f right %.3f both %.3f px; T %.3f %.3f %.3f mm; epipolar RMS %.3f p95 %.3f px\n",
        name, c.pairs_used, c.rms_left_px, c.rms_right_px, c.rms_px, c.rig.shift_mm.x, c.rig.shift_mm.y,
        c.rig.shift_mm.z, q.epipolar_rms_px, q.epipolar_p95_px);
    std::printf("  held out: shape %.3f mm, depth %.3f mm, size %.3f %%; depth by calibration", q.held_out_mm,
                q.held_out_depth_mm, q.held_out_size_percent);
    for (const DepthError& d : q.depth)
        std::printf(", %.0f mm +- %.2f", d.distance_mm, d.calibration_mm);
    std::printf("; coverage %.0f %% %.0f %%; %s\n", 100 * q.left.share, 100 * q.right.share, name_of(q.verdict));
    for (const std::string& advice : q.advice)
        std::printf("  - %s\n", advice.c_str());
}

TEST(RealPairs, AllFoundAndSolvedAsWellAsByOpenCv)
{
    if (!test::data_there(kOpenCvPairs.folder))
        return;
    CalibrationTask task;
    EXPECT_EQ(test::add_pairs(kOpenCvPairs, task), 0);
    EXPECT_EQ(task.views.size(), 13U);
    const auto solved = solve_stereo(task);
    ASSERT_TRUE(solved.ok()) << solved.status().message();
    const StereoCalibration& c = solved.value();
    const Quality q = assess(task, c, {250, 550});
    print("real pairs", c, q);
    EXPECT_EQ(c.pairs_used, 13);
    EXPECT_LE(c.rms_px, 0.22); // OpenCV 4.6: 0.215
    EXPECT_NEAR(c.rig.shift_mm.x, -99.81, 0.3);
    EXPECT_NEAR(c.rig.shift_mm.y, 1.10, 0.3);
    EXPECT_NEAR(c.rig.shift_mm.z, -0.14, 0.3);
    EXPECT_NEAR(c.rig.left.fx, 533.56, 1.5);
    EXPECT_NEAR(c.rig.right.fx, 536.89, 1.5);
    EXPECT_NE(q.verdict, Verdict::kRedo);
}

double depth_error_mm(const StereoRig& truth, const StereoRig& rig, double distance_mm)
{
    double squares = 0;
    int count = 0;
    for (int y = 40; y < truth.height; y += 80)
        for (int x = 40; x < truth.width; x += 80) {
            const Point2 left{static_cast<double>(x), static_cast<double>(y)};
            const auto direction = undistort(truth.left, left);
            const Point2 right = test::reference_project(
                truth.right, truth.into_right({direction->x * distance_mm, direction->y * distance_mm, distance_mm}));
            if (right.x < 0 || right.y < 0 || right.x > truth.width - 1 || right.y > truth.height - 1)
                continue;
            const auto at = triangulate(rig, *undistort(rig.left, left), *undistort(rig.right, right));
            squares += (at->z - distance_mm) * (at->z - distance_mm);
            ++count;
        }
    return std::sqrt(squares / count);
}

class RenderedRig : public testing::TestWithParam<PairSet>
{
};

TEST_P(RenderedRig, IsFoundFromOneBoardAlone)
{
    const PairSet& set = GetParam();
    if (!test::data_there(set.folder))
        return;
    const StereoRig truth = test::rig_dev_truth();
    CalibrationTask task;
    EXPECT_EQ(test::add_pairs(set, task), 0);
    EXPECT_EQ(task.views.size(), 20U);
    const auto solved = solve_stereo(task);
    ASSERT_TRUE(solved.ok()) << solved.status().message();
    const StereoCalibration& c = solved.value();
    const Quality q = assess(task, c, {400, 1300});
    print(set.folder, c, q);

    const double baseline = c.rig.baseline_mm() - truth.baseline_mm();
    const double turn_deg = test::turn_between_deg(c.rig.turn, truth.turn);
    std::printf("  off by: baseline %.4f mm, rotation %.4f deg", baseline, turn_deg);
    EXPECT_LT(std::abs(baseline), 0.05);
    EXPECT_LT(turn_deg, 0.01);
    for (const auto& [found, expected] : {std::pair{c.rig.left, truth.left}, std::pair{c.rig.right, truth.right}}) {
        std::printf(", fx %.4f %%, centre %.3f %.3f px", 100 * (found.fx / expected.fx - 1), found.cx - expected.cx,
                    found.cy - expected.cy);
        EXPECT_LT(std::abs(found.fx / expected.fx - 1), 1e-3);
        EXPECT_LT(std::abs(found.fy / expected.fy - 1), 1e-3);
        EXPECT_LT(std::abs(found.cx - expected.cx), 0.5);
        EXPECT_LT(std::abs(found.cy - expected.cy), 0.5);
    }
    // Detection alone: how far the corners are from the rows of the true geometry.
    double squares = 0;
    int corners = 0;
    for (const View& view : task.views)
        for (std::size_t k = 0; k < view.left.size(); ++k, ++corners) {
            const double distance = epipolar_distance_px(truth, view.left[k], view.right[k]).value();
            squares += distance * distance;
        }
    const double epipolar_px = std::sqrt(squares / corners);
    std::printf(", epipolar RMS of the true geometry %.4f px\n", epipolar_px);
    EXPECT_LT(epipolar_px, 0.1);
    EXPECT_EQ(q.verdict, Verdict::kGood);
}

INSTANTIATE_TEST_SUITE_P(Boards, RenderedRig, testing::Values(kBoard10, kBoard8),
                         [](const auto& set) { return set.param.board.cols == 9 ? "Board10" : "Board8"; });

TEST(RenderedRigParts, DepthIsOffByWhatIsPredicted)
{
    if (!test::data_there(kBoard10.folder))
        return;
    const StereoRig truth = test::rig_dev_truth();
    std::vector<CalibrationTask> parts;
    for (const PairSet& set : {kBoard10, kBoard8}) {
        CalibrationTask task;
        ASSERT_EQ(test::add_pairs(set, task), 0);
        for (std::size_t part = 0; part < 2; ++part) {
            parts.push_back(task);
            parts.back().views.clear();
            for (std::size_t v = part; v < task.views.size(); v += 2)
                parts.back().views.push_back(task.views[v]);
        }
        parts.push_back(task);
    }
    for (const double distance_mm : {500.0, 800.0, 1000.0}) {
        double real = 0;
        double predicted = 0;
        for (const CalibrationTask& task : parts) {
            const auto solved = solve_stereo(task);
            ASSERT_TRUE(solved.ok()) << solved.status().message();
            const double error = depth_error_mm(truth, solved.value().rig, distance_mm);
            const double prediction = predict_depth_error(solved.value(), distance_mm).calibration_mm;
            std::printf("  %2zu pairs at %4.0f mm: depth off by %.3f mm, predicted %.3f mm\n", task.views.size(),
                        distance_mm, error, prediction);
            if (task.views.size() == 20) { // all pictures of a board
                EXPECT_LT(error, 2 * prediction);
            }
            real += error * error;
            predicted += prediction * prediction;
        }
        const double ratio = std::sqrt(real / predicted);
        std::printf("%4.0f mm: off by %.2f times the prediction over %zu calibrations that share views\n", distance_mm,
                    ratio, parts.size());
        EXPECT_GT(ratio, 0.5);
        EXPECT_LT(ratio, 2.0);
    }
}

TEST(RenderedRigEffort, FortyPairsTake256MiBAtMost)
{
    if (!test::data_there(kBoard10.folder))
        return;
    const std::clock_t start = std::clock();
    CalibrationTask task;
    EXPECT_EQ(test::add_pairs(kBoard10, task) + test::add_pairs(kBoard8, task), 0);
    const std::clock_t detected = std::clock();
    const auto solved = solve_stereo(task);
    ASSERT_TRUE(solved.ok()) << solved.status().message();
    const std::clock_t end = std::clock();
    const auto memory = process_memory();
    ASSERT_TRUE(memory.ok());
    const double mib = static_cast<double>(memory.value().peak_bytes) / 1048576;
    std::printf("40 pairs of 1280 x 720: read and found in %.2f s, solved in %.2f s of one core; peak %.0f MiB\n",
                static_cast<double>(detected - start) / CLOCKS_PER_SEC,
                static_cast<double>(end - detected) / CLOCKS_PER_SEC, mib);
    std::printf("both boards: baseline off by %.4f mm, rotation by %.4f deg\n",
                solved.value().rig.baseline_mm() - test::rig_dev_truth().baseline_mm(),
                test::turn_between_deg(solved.value().rig.turn, test::rig_dev_truth().turn));
    if (kInstrumented) {
        std::printf("NOT RUN: the limit of memory, under sanitizers\n");
        return;
    }
    EXPECT_LE(mib, 256);
}

} // namespace
} // namespace dicot::calibration
