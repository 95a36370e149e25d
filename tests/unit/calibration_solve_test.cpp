#include "dicot/calibration/camera.h"
#include "dicot/calibration/solve.h"

#include "rig_scene.h"

#include "bundle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dicot::calibration {
namespace {

using test::turn_about;
using test::webcam_rig;

const Board kBoard{9, 7, 35};

std::array<double, kRigNumbers> numbers_of(const StereoRig& rig)
{
    std::array<double, kRigNumbers> n{};
    for (const bool right : {false, true}) {
        const Lens& lens = right ? rig.right : rig.left;
        const std::size_t first = right ? 9 : 0;
        n[first] = lens.fx;
        n[first + 1] = lens.fy;
        n[first + 2] = lens.cx;
        n[first + 3] = lens.cy;
        std::copy_n(lens.k.begin(), 5, n.begin() + static_cast<std::ptrdiff_t>(first) + 4);
    }
    n[21] = rig.shift_mm.x;
    n[22] = rig.shift_mm.y;
    n[23] = rig.shift_mm.z;
    return n;
}

TEST(Undistort, TakesBackTheReferenceProjection)
{
    const StereoRig rig = webcam_rig();
    for (double x = -0.75; x < 0.8; x += 0.13)
        for (double y = -0.45; y < 0.5; y += 0.11) {
            const Point2 pixel = test::reference_project(rig.left, {x * 700, y * 700, 700});
            const Point2 own = project(rig.left, {x * 700, y * 700, 700});
            EXPECT_NEAR(own.x, pixel.x, 1e-9);
            EXPECT_NEAR(own.y, pixel.y, 1e-9);
            const auto direction = undistort(rig.left, pixel);
            ASSERT_TRUE(direction);
            EXPECT_NEAR(direction->x, x, 1e-12);
            EXPECT_NEAR(direction->y, y, 1e-12);
        }
}

TEST(Undistort, HasNoAnswerWhereTheDistortionFoldsBack)
{
    const Lens lens{500, 500, 320, 240, {-0.5, 0, 0, 0, 0}};
    EXPECT_FALSE(undistort(lens, {320 + 500 * 0.6, 240})); // x - x^3 / 2 never exceeds 0.544
    EXPECT_TRUE(undistort(lens, {320 + 500 * 0.5, 240}));
}

TEST(Triangulate, FindsThePointThatBothCamerasSee)
{
    const StereoRig rig = webcam_rig();
    const Point3 p{120, -60, 830};
    const Point3 q = rig.into_right(p);
    const auto found = triangulate(rig, {p.x / p.z, p.y / p.z}, {q.x / q.z, q.y / q.z});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->x, p.x, 1e-8);
    EXPECT_NEAR(found->y, p.y, 1e-8);
    EXPECT_NEAR(found->z, p.z, 1e-8);
    StereoRig blind = rig;
    blind.turn = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    EXPECT_FALSE(triangulate(blind, {0.1, 0.2}, {0.1, 0.2}));
}

TEST(EpipolarDistance, IsTheShiftAcrossTheRowsOfAnAlignedRig)
{
    StereoRig rig = webcam_rig();
    rig.left = rig.right = {800, 800, 640, 360, {}};
    rig.turn = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    rig.shift_mm = {-85, 0, 0};
    EXPECT_NEAR(epipolar_distance_px(rig, {500, 300}, {420, 300.7}).value(), 0.7, 1e-12);
}

TEST(CornerTerm, DerivativesAgreeWithDifferences)
{
    Bundle bundle;
    const StereoRig rig = webcam_rig();
    Lens left = rig.left;
    left.k[4] = 0.01;
    bundle.lens = {lens_vector(left), lens_vector(rig.right)};
    bundle.rig = {quaternion_of(rig.turn), {-84.6, 1.1, 1.4}};
    bundle.warp = {0.7, -0.4};
    BundleView view{&kBoard, {}, {}, {quaternion_of(turn_about(23, -31, 8)), {60, -40, 640}}, true};
    std::fill(bundle.fitted.begin(), bundle.fitted.end(), true);

    for (const bool right : {false, true})
        for (const auto& corner : {std::pair{0, 0}, std::pair{8, 2}, std::pair{4, 6}}) {
            const int col = corner.first;
            const int row = corner.second;
            const Term term = corner_term(bundle, view, right, col, row, {600, 300});
            ASSERT_TRUE(term.in_front);
            const auto check = [&](double analytic_x, double analytic_y, double step, const auto& moved) {
                const Eigen::Vector2d up = moved(step);
                const Eigen::Vector2d down = moved(-step);
                const Eigen::Vector2d difference = (up - down) / (2 * step);
                EXPECT_NEAR(difference.x(), analytic_x, 1e-5 * (1 + std::abs(analytic_x)));
                EXPECT_NEAR(difference.y(), analytic_y, 1e-5 * (1 + std::abs(analytic_y)));
            };
            for (int k = 0; k < kShared; ++k) {
                SCOPED_TRACE(testing::Message() << "shared number " << k << ", right " << right);
                check(term.by_shared(0, k), term.by_shared(1, k), k < kRigPose || k >= kRigPose + 3 ? 1e-4 : 1e-6,
                      [&](double by) {
                          Bundle b = bundle;
                          if (k < kRightLens)
                              b.lens[0][k] += by;
                          else if (k < kRigPose)
                              b.lens[1][k - kRightLens] += by;
                          else if (k < kWarp)
                              b.rig = b.rig.moved(by * PoseVector::Unit(k - kRigPose));
                          else
                              b.warp[k - kWarp] += by;
                          return corner_term(b, view, right, col, row, {600, 300}).residual;
                      });
            }
            for (int k = 0; k < 6; ++k) {
                SCOPED_TRACE(testing::Message() << "pose number " << k << ", right " << right);
                check(term.by_pose(0, k), term.by_pose(1, k), k < 3 ? 1e-6 : 1e-4, [&](double by) {
                    BundleView v = view;
                    v.pose = v.pose.moved(by * PoseVector::Unit(k));
                    return corner_term(bundle, v, right, col, row, {600, 300}).residual;
                });
            }
        }
}

TEST(SolveStereo, FindsTheRigBehindExactCorners)
{
    const StereoRig truth = webcam_rig();
    const auto solved = solve_stereo(test::varied_task(truth, kBoard, 12, 0, 3));
    ASSERT_TRUE(solved.ok()) << solved.status().message();
    const StereoRig& rig = solved.value().rig;
    EXPECT_LT(solved.value().rms_px, 1e-6);
    const auto found = numbers_of(rig);
    const auto expected = numbers_of(truth);
    for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k], expected[k], 1e-5 * (1 + std::abs(expected[k]))) << k;
    EXPECT_LT(test::turn_between_deg(rig.turn, truth.turn), 1e-5);
}

TEST(SolveStereo, FindsWideLensesWithStrongDistortion)
{
    StereoRig truth = webcam_rig();
    truth.left = {520, 521, 645, 352, {-0.30, 0.11, 0.001, -0.001, 0}};
    truth.right = {524, 523, 630, 366, {-0.29, 0.10, -0.001, 0.0005, 0}};
    const auto solved = solve_stereo(test::varied_task(truth, kBoard, 14, 0.05, 8));
    ASSERT_TRUE(solved.ok()) << solved.status().message();
    EXPECT_NEAR(solved.value().rig.left.fx, 520, 1);
    EXPECT_NEAR(solved.value().rig.right.k[0], -0.29, 0.01);
    EXPECT_LT(test::turn_between_deg(solved.value().rig.turn, truth.turn), 0.05);
}

TEST(SolveStereo, SpreadsAsItsCovarianceSays)
{
    const StereoRig truth = webcam_rig();
    constexpr int kRuns = 40;
    constexpr double kNoise_px = 0.1;
    std::array<double, kRigNumbers> squares{};
    std::array<double, kRigNumbers> predicted{};
    double sigma = 0;
    for (std::uint32_t run = 0; run < kRuns; ++run) {
        // The same boards with other noise.
        CalibrationTask task = test::varied_task(truth, kBoard, 12, 0, 3);
        std::mt19937 random(100 + run);
        std::normal_distribution<double> noise(0, kNoise_px);
        for (View& view : task.views)
            for (std::vector<Point2>* side : {&view.left, &view.right})
                for (Point2& p : *side)
                    p = {p.x + noise(random), p.y + noise(random)};
        const auto solved = solve_stereo(task);
        ASSERT_TRUE(solved.ok()) << solved.status().message() << " (seed " << 100 + run << ")";
        const auto found = numbers_of(solved.value().rig);
        const auto expected = numbers_of(truth);
        for (std::size_t k = 0; k < found.size(); ++k) {
            squares[k] += (found[k] - expected[k]) * (found[k] - expected[k]) / kRuns;
            predicted[k] += solved.value().deviation(static_cast<int>(k)) / kRuns;
        }
        sigma += solved.value().sigma_px / kRuns;
    }
    EXPECT_NEAR(sigma, kNoise_px, 0.01);
    for (const std::size_t k : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U, 9U, 10U, 11U, 12U, 13U, 14U, 15U, 16U, 21U, 22U, 23U}) {
        const double ratio = std::sqrt(squares[k]) / predicted[k];
        EXPECT_GT(ratio, 0.65) << "number " << k; // 40 runs tell a deviation to 11 %
        EXPECT_LT(ratio, 1.5) << "number " << k;
    }
}

TEST(SolveStereo, FindsTheBowOfABoard)
{
    const StereoRig truth = webcam_rig();
    CalibrationTask task = test::varied_task(truth, kBoard, 0, 0, 1);
    std::mt19937 random(4);
    while (task.views.size() < 12) {
        const test::Placement place = test::any_place(truth, random);
        View view;
        for (int row = 0; row < kBoard.rows; ++row)
            for (int col = 0; col < kBoard.cols; ++col) {
                const double u = (col - 4) / 4.0;
                const double v = (row - 3) / 3.0;
                const Point3 p{35.0 * (col - 4), 35.0 * (row - 3), 1.5 * (1 - u * u) - 0.8 * (1 - v * v)};
                view.left.push_back(test::reference_project(truth.left, place(p)));
                view.right.push_back(test::reference_project(truth.right, test::in_right(truth, place)(p)));
            }
        if (test::inside(truth, view))
            task.views.push_back(view);
    }
    const auto flat = solve_stereo(task);
    task.fit_warp = true;
    const auto bowed = solve_stereo(task);
    ASSERT_TRUE(flat.ok() && bowed.ok());
    EXPECT_GT(flat.value().rms_px, 0.05);
    EXPECT_LT(bowed.value().rms_px, 1e-5);
    EXPECT_NEAR(bowed.value().warp_mm[0], 1.5, 1e-3);
    EXPECT_NEAR(bowed.value().warp_mm[1], -0.8, 1e-3);
}

TEST(SolveStereo, TakesSeveralBoardsAndViewsOfOneCameraAlone)
{
    const StereoRig truth = webcam_rig();
    const Board other{7, 7, 46};
    CalibrationTask task = test::varied_task(truth, kBoard, 8, 0.05, 5);
    CalibrationTask more = test::varied_task(truth, other, 6, 0.05, 6);
    task.boards.push_back(other);
    for (View& view : more.views) {
        view.board = 1;
        task.views.push_back(view);
    }
    task.views[1].left.clear();
    task.views[9].right.clear();
    task.views[10].left.clear();
    task.views[10].right.clear();
    const auto solved = solve_stereo(task);
    ASSERT_TRUE(solved.ok()) << solved.status().message();
    EXPECT_EQ(solved.value().pairs_used, 11);
    EXPECT_TRUE(solved.value().views[1].used);
    EXPECT_FALSE(solved.value().views[10].used);
    EXPECT_NEAR(solved.value().rig.baseline_mm(), truth.baseline_mm(), 0.1);
}

TEST(SolveStereo, DropsAndNamesPairsThatDoNotFit)
{
    const StereoRig truth = webcam_rig();
    CalibrationTask task = test::varied_task(truth, kBoard, 16, 0.05, 7);
    std::mt19937 random(9);
    // The board moves by 4 mm between the pictures of pair 3.
    test::Placement place{turn_about(20, 10, 3), {20, -30, 700}};
    task.views[3].left = test::board_corners(kBoard, place, truth.left);
    place.shift_mm.y += 4;
    task.views[3].right = test::board_corners(kBoard, test::in_right(truth, place), truth.right);
    // The right corners of pair 6 are counted from the opposite end.
    std::reverse(task.views[6].right.begin(), task.views[6].right.end());
    // Pair 11 is blurred.
    std::normal_distribution<double> noise(0, 1.2);
    for (Point2& p : task.views[11].left)
        p = {std::clamp(p.x + noise(random), 0.0, 1279.0), std::clamp(p.y + noise(random), 0.0, 719.0)};

    const auto solved = solve_stereo(task);
    ASSERT_TRUE(solved.ok()) << solved.status().message();
    const StereoCalibration& c = solved.value();
    EXPECT_EQ(c.pairs_used, 13);
    EXPECT_THAT(c.views[3].reason, testing::HasSubstr("did the board move"));
    EXPECT_THAT(c.views[6].reason, testing::HasSubstr("different corners"));
    EXPECT_THAT(c.views[11].reason, testing::HasSubstr("corners are off by"));
    for (std::size_t v = 0; v < c.views.size(); ++v)
        EXPECT_EQ(c.views[v].used, c.views[v].reason.empty()) << v;
    EXPECT_NEAR(c.rig.baseline_mm(), truth.baseline_mm(), 0.1);
    EXPECT_LT(test::turn_between_deg(c.rig.turn, truth.turn), 0.03);
}

TEST(SolveStereo, IsNotBentBySingleWrongCorners)
{
    const StereoRig truth = webcam_rig();
    CalibrationTask task = test::varied_task(truth, kBoard, 14, 0.05, 11);
    for (std::size_t v = 0; v < task.views.size(); v += 2)
        task.views[v].left[5 + v].x += 1.1;
    const auto solved = solve_stereo(task);
    ASSERT_TRUE(solved.ok()) << solved.status().message();
    EXPECT_EQ(solved.value().pairs_used, 14);
    EXPECT_NEAR(solved.value().rig.left.fx, truth.left.fx, 0.4);
    EXPECT_NEAR(solved.value().rig.baseline_mm(), truth.baseline_mm(), 0.05);
}

void expect_refusal(const CalibrationTask& task, const char* because)
{
    const auto solved = solve_stereo(task);
    ASSERT_FALSE(solved.ok()) << because;
    EXPECT_EQ(solved.status().fault(), Fault::kBadData) << because;
    EXPECT_THAT(solved.status().message(), testing::HasSubstr(because));
}

TEST(SolveStereo, RefusesViewsThatAreAllAlike)
{
    const StereoRig rig = webcam_rig();
    std::mt19937 random(2);
    CalibrationTask task = test::varied_task(rig, kBoard, 0, 0, 1);
    for (int k = 0; k < 12; ++k)
        task.views.push_back(
            test::view_of(rig, kBoard, 0, {turn_about(12 + 0.2 * k, -8, 3), {5.0 * k, 10, 650}}, 0.05, random));
    expect_refusal(task, "all views are alike");
    task.views.clear();
    for (int k = 0; k < 12; ++k) // flat before the cameras, at several distances
        task.views.push_back(
            test::view_of(rig, kBoard, 0, {turn_about(0, 0, 3.0 * k), {0, 0, 600 + 30.0 * k}}, 0.05, random));
    expect_refusal(task, "all views are alike");
}

TEST(SolveStereo, RefusesSwappedCameras)
{
    CalibrationTask task = test::varied_task(webcam_rig(), kBoard, 10, 0.05, 4);
    for (View& view : task.views)
        std::swap(view.left, view.right);
    expect_refusal(task, "left and right are swapped");
}

TEST(SolveStereo, RefusesCamerasAboveEachOther)
{
    StereoRig rig = webcam_rig();
    rig.shift_mm = {2, -70, 0};
    expect_refusal(test::varied_task(rig, kBoard, 10, 0.05, 4), "do not stand side by side");
}

TEST(SolveStereo, RefusesWhatIsMissingOrDoesNotBelong)
{
    const CalibrationTask good = test::varied_task(webcam_rig(), kBoard, 10, 0.05, 4);
    CalibrationTask task = good;
    for (View& view : task.views)
        view.right.clear();
    expect_refusal(task, "only the left camera saw the board");
    task = good;
    task.views.resize(3);
    expect_refusal(task, "3 pairs show the whole board");
    task.views.clear();
    expect_refusal(task, "0 pairs show the whole board");
    task = good;
    task.views[2].left.pop_back();
    expect_refusal(task, "62 corners on a board of 63");
    task = good;
    task.views[2].left[3].x = NAN;
    expect_refusal(task, "lies outside the 1280 x 720 picture");
    task = good;
    task.views[2].board = 1;
    expect_refusal(task, "names board 1");
    task = good;
    task.boards[0].square_mm = 0;
    EXPECT_EQ(solve_stereo(task).status().fault(), Fault::kUsage);
}

TEST(SolveStereo, RefusesPairsOfCamerasThatMoved)
{
    std::mt19937 random(12);
    CalibrationTask task = test::varied_task(webcam_rig(), kBoard, 0, 0, 1);
    while (task.views.size() < 10) {
        StereoRig rig = webcam_rig(); // turned by tens of degrees from pair to pair
        rig.turn = turn_about(0, 0, 25.0 * static_cast<double>(task.views.size()));
        View view = test::view_of(rig, kBoard, 0, test::any_place(rig, random), 0.05, random);
        if (test::inside(rig, view))
            task.views.push_back(view);
    }
    expect_refusal(task, "pairs fit together");
}

TEST(SolveAgain, UsesTheChosenViewsOnly)
{
    const StereoRig truth = webcam_rig();
    const CalibrationTask task = test::varied_task(truth, kBoard, 10, 0.1, 4);
    const auto all = solve_stereo(task);
    ASSERT_TRUE(all.ok());
    const std::array<bool, 10> chosen{true, true, true, true, true, true, false, false, true, true};
    const StereoCalibration part = solve_again(task, all.value(), chosen);
    EXPECT_EQ(part.pairs_used, 8);
    EXPECT_FALSE(part.views[6].used);
    CalibrationTask smaller = task;
    smaller.views.erase(smaller.views.begin() + 6, smaller.views.begin() + 8);
    const auto direct = solve_stereo(smaller);
    ASSERT_TRUE(direct.ok());
    EXPECT_NEAR(part.rig.left.fx, direct.value().rig.left.fx, 0.05);
    EXPECT_NEAR(part.rig.shift_mm.x, direct.value().rig.shift_mm.x, 0.01);
}

} // namespace
} // namespace dicot::calibration
