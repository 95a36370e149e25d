// The same pictures through our eyes and OpenCV's: both are printed, ours is held to what it promises.
#include "opencv_eyes.h"
#include "rig_scene.h"

#include "dicot/calibration/camera.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>

namespace dicot {
namespace {

using calibration::CalibrationTask;
using calibration::View;
using test::OpenCvEyes;
using test::PairSet;
using test::Solved;

struct PicturePair
{
    int number = 0;
    test::GreyPicture left;
    test::GreyPicture right;
};

std::vector<PicturePair> pictures_of(const PairSet& set)
{
    std::vector<PicturePair> pairs;
    for (int number = set.first; number <= set.last; ++number) {
        if (number == set.missing)
            continue;
        auto left = test::grey_picture(set.path(0, number)), right = test::grey_picture(set.path(1, number));
        EXPECT_TRUE(left.ok()) << left.status().message();
        EXPECT_TRUE(right.ok()) << right.status().message();
        if (left.ok() && right.ok())
            pairs.push_back({number, std::move(left).value(), std::move(right).value()});
    }
    return pairs;
}

double core_seconds()
{
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// What one detector and one solver made of a set of pairs.
struct Row
{
    std::string who;
    int boards = 0; ///< pictures in which the board was found
    CalibrationTask task;
    std::vector<int> numbers; ///< of the pairs behind the task's views
    double find_s = 0;
    double solve_s = 0;
    Solved solved;
};

Row seen_by_us(std::vector<PicturePair>& pairs, const test::Board& board)
{
    Row row;
    row.who = "ours";
    row.task.boards = {board};
    const double start = core_seconds();
    for (PicturePair& pair : pairs) {
        const auto left = calibration::find_board(pair.left.view(), board);
        auto right = calibration::find_board(pair.right.view(), board);
        row.boards += left.found + right.found;
        if (!left.found || !right.found || !calibration::agree_on_order(board, left, right).ok())
            continue;
        row.task.views.push_back({0, left.corners, right.corners});
        row.numbers.push_back(pair.number);
    }
    row.find_s = core_seconds() - start;
    return row;
}

double distance_px(Point2 a, Point2 b)
{
    return std::hypot(a.x - b.x, a.y - b.y);
}

/// `theirs` in the order of `ours`, since boards that look alike after a turn leave the order open. Nothing where one
/// of our corners has none of theirs within half a square.
std::vector<Point2> in_order_of(const std::vector<Point2>& ours, const std::vector<Point2>& theirs)
{
    std::vector<Point2> ordered;
    const double reach_px = distance_px(ours[0], ours[1]) / 2;
    for (const Point2& mine : ours) {
        const auto nearest = std::ranges::min_element(theirs, {}, [&](Point2 p) { return distance_px(p, mine); });
        if (nearest == theirs.end() || distance_px(*nearest, mine) > reach_px)
            return {};
        ordered.push_back(*nearest);
    }
    return ordered;
}

Row seen_by_opencv(OpenCvEyes eyes, const char* who, std::vector<PicturePair>& pairs, const test::Board& board,
                   const Row& ours)
{
    Row row;
    row.who = who;
    row.task.boards = {board};
    for (PicturePair& pair : pairs) {
        const double start = core_seconds();
        const auto left = test::corners_by_opencv(eyes, pair.left, board);
        const auto right = test::corners_by_opencv(eyes, pair.right, board);
        row.find_s += core_seconds() - start;
        row.boards += !left.empty() + !right.empty();
        const auto same = std::ranges::find(ours.numbers, pair.number);
        if (left.empty() || right.empty() || same == ours.numbers.end())
            continue;
        const View& mine = ours.task.views[static_cast<std::size_t>(same - ours.numbers.begin())];
        View view{0, in_order_of(mine.left, left), in_order_of(mine.right, right)};
        if (view.left.empty() || view.right.empty()) {
            std::printf("%s: pair %d has corners elsewhere\n", who, pair.number);
            continue;
        }
        row.task.views.push_back(std::move(view));
        row.numbers.push_back(pair.number);
    }
    return row;
}

/// All rows of one set, solved.
std::vector<Row> rows_of(const PairSet& set)
{
    cv::setNumThreads(1);
    std::vector<PicturePair> pairs = pictures_of(set);
    std::vector<Row> rows{seen_by_us(pairs, set.board)};
    rows.push_back(seen_by_opencv(OpenCvEyes::kPlain, "OpenCV " CV_VERSION, pairs, set.board, rows[0]));
    rows.push_back(seen_by_opencv(OpenCvEyes::kSectors, "OpenCV, SB corners", pairs, set.board, rows[0]));
    rows.push_back(rows[0]);
    rows.back().who = "our corners, its solver";
    for (Row& row : rows) {
        row.task.width = pairs[0].left.width;
        row.task.height = pairs[0].left.height;
        const double start = core_seconds();
        if (&row == rows.data()) {
            const auto solved = calibration::solve_stereo(row.task);
            EXPECT_TRUE(solved.ok()) << solved.status().message();
            if (solved.ok())
                row.solved = {solved.value().rig, solved.value().rms_px};
        } else if (!row.task.views.empty()) {
            row.solved = test::solved_by_opencv(row.task);
        }
        row.solve_s = core_seconds() - start;
    }
    return rows;
}

/// The median distance between our corners and those of `row`, in px.
double apart_px(const Row& ours, const Row& row)
{
    std::vector<double> distances;
    for (std::size_t v = 0; v < row.numbers.size(); ++v) {
        const auto same = std::ranges::find(ours.numbers, row.numbers[v]) - ours.numbers.begin();
        const View& mine = ours.task.views[static_cast<std::size_t>(same)];
        for (const auto& [a, b] :
             {std::pair{&mine.left, &row.task.views[v].left}, {&mine.right, &row.task.views[v].right}})
            for (std::size_t k = 0; k < a->size(); ++k)
                distances.push_back(distance_px((*a)[k], (*b)[k]));
    }
    if (distances.empty())
        return 0;
    std::ranges::nth_element(distances, distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2));
    return distances[distances.size() / 2];
}

void print(const PairSet& set, const std::vector<Row>& rows)
{
    std::printf("%s\n%-24s | boards | pairs | RMS px |  apart px |         T mm          | find s | solve s\n",
                set.folder, "");
    for (const Row& row : rows) {
        const Point3& t = row.solved.rig.shift_mm;
        std::printf("%-24s | %6d | %5zu | %6.4f | %9.4f | %8.3f %5.2f %6.2f | %6.2f | %7.2f\n", row.who.c_str(),
                    row.boards, row.task.views.size(), row.solved.rms_px, apart_px(rows[0], row), t.x, t.y, t.z,
                    row.find_s, row.solve_s);
    }
}

TEST(BesideOpenCv, RealPairs)
{
    if (!test::data_there(test::kOpenCvPairs.folder))
        return;
    const std::vector<Row> rows = rows_of(test::kOpenCvPairs);
    print(test::kOpenCvPairs, rows);
    const Row& ours = rows[0];
    EXPECT_EQ(ours.boards, 26);
    EXPECT_EQ(ours.task.views.size(), 13U);
    EXPECT_LE(ours.solved.rms_px, 0.22);
    EXPECT_LE(ours.solved.rms_px, rows[1].solved.rms_px);
    EXPECT_NEAR(ours.solved.rig.shift_mm.x, -99.81, 0.3);
    EXPECT_NEAR(ours.solved.rig.shift_mm.y, 1.10, 0.3);
    EXPECT_NEAR(ours.solved.rig.shift_mm.z, -0.14, 0.3);
}

/// How far a solution is from the truth, and its corners from the rows of the true geometry.
struct Errors
{
    double baseline_mm, turn_deg, focal_percent, centre_px, epipolar_px;
};

Errors errors_of(const Row& row, const StereoRig& truth)
{
    const StereoRig& rig = row.solved.rig;
    Errors errors{std::fabs(rig.baseline_mm() - truth.baseline_mm()), test::turn_between_deg(rig.turn, truth.turn), 0,
                  0, 0};
    for (const auto& [found, expected] : {std::pair{&rig.left, &truth.left}, {&rig.right, &truth.right}}) {
        errors.focal_percent = std::max({errors.focal_percent, 100 * std::fabs(found->fx / expected->fx - 1),
                                         100 * std::fabs(found->fy / expected->fy - 1)});
        errors.centre_px =
            std::max({errors.centre_px, std::fabs(found->cx - expected->cx), std::fabs(found->cy - expected->cy)});
    }
    double squares = 0;
    int corners = 0;
    for (const View& view : row.task.views)
        for (std::size_t k = 0; k < view.left.size(); ++k, ++corners) {
            const double distance = calibration::epipolar_distance_px(truth, view.left[k], view.right[k]).value_or(0);
            squares += distance * distance;
        }
    errors.epipolar_px = std::sqrt(squares / std::max(corners, 1));
    return errors;
}

class BesideOpenCvRendered : public testing::TestWithParam<PairSet>
{
};

TEST_P(BesideOpenCvRendered, BoardsAgainstTheTruth)
{
    const PairSet& set = GetParam();
    if (!test::data_there(set.folder))
        return;
    const std::vector<Row> rows = rows_of(set);
    const StereoRig truth = test::rig_dev_truth();
    print(set, rows);
    std::printf("%-24s | baseline mm | rotation deg | focal %% | centre px | epipolar px of the truth\n",
                "off by at most");
    for (const Row& row : rows) {
        const Errors e = errors_of(row, truth);
        std::printf("%-24s | %11.4f | %12.5f | %7.4f | %9.3f | %.4f\n", row.who.c_str(), e.baseline_mm, e.turn_deg,
                    e.focal_percent, e.centre_px, e.epipolar_px);
    }
    const Row& ours = rows[0];
    const Errors e = errors_of(ours, truth);
    EXPECT_EQ(ours.boards, 40);
    EXPECT_EQ(ours.task.views.size(), 20U);
    EXPECT_LE(ours.solved.rms_px, rows[1].solved.rms_px);
    EXPECT_LT(e.baseline_mm, 0.05);
    EXPECT_LT(e.turn_deg, 0.01);
    EXPECT_LT(e.focal_percent, 0.1);
    EXPECT_LT(e.centre_px, 0.5);
    EXPECT_LT(e.epipolar_px, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Boards, BesideOpenCvRendered, testing::Values(test::kBoard10, test::kBoard8),
                         [](const auto& set) { return set.param.board.cols == 9 ? "Board10" : "Board8"; });

} // namespace
} // namespace dicot
