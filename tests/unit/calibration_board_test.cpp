#include "dicot/calibration/board.h"

#include "board_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dicot::calibration {
namespace {

using test::Photo;
using test::Scene;
using test::turn_about;

/// The distance of found corners from true ones, over the turns that leave the board's outline as it is.
double worst_miss_px(const Scene& scene, const BoardSight& sight)
{
    const std::vector<Point2> truth = test::board_corners(scene.board, scene.place, scene.lens);
    double best = 1e9;
    const int cols = scene.board.cols;
    const int rows = scene.board.rows;
    for (int turn = 0; turn < (cols == rows ? 4 : 2); ++turn) {
        double worst = 0;
        for (int row = 0; row < rows; ++row)
            for (int col = 0; col < cols; ++col) {
                int c = col;
                int r = row;
                for (int k = 0; k < (cols == rows ? turn : 2 * turn); ++k) {
                    const int side = (k % 2 == 0 ? cols : rows) - 1;
                    const int old = c;
                    c = r;
                    r = side - old;
                }
                const Point2 p = sight.corners[static_cast<std::size_t>(row * cols + col)];
                const Point2 q = truth[static_cast<std::size_t>(r * cols + c)];
                worst = std::max(worst, std::hypot(p.x - q.x, p.y - q.y));
            }
        best = std::min(best, worst);
    }
    return best;
}

void expect_found(const Scene& scene, double within_px, const char* what)
{
    const Photo photo = test::photograph(scene);
    const BoardSight sight = find_board(photo.view(), scene.board);
    ASSERT_TRUE(sight.found) << what << ": " << sight.reason << " (seed " << scene.seed << ")";
    ASSERT_EQ(sight.corners.size(), static_cast<std::size_t>(scene.board.corner_count()));
    const double miss = worst_miss_px(scene, sight);
    std::printf("%s: worst %.3f px\n", what, miss);
    EXPECT_LT(miss, within_px) << what << " (seed " << scene.seed << ")";
}

TEST(FindBoard, PutsCleanCornersWithin8HundredthsOfAPixel)
{
    Scene scene;
    std::uint32_t seed = 1;
    for (const double tilt : {0.0, 20.0, 35.0})
        for (const double roll : {-30.0, 4.0}) {
            scene.place = {turn_about(tilt, 0.6 * tilt, roll), {10, -5, 560}};
            scene.seed = seed++;
            expect_found(scene, 0.08, "clean board");
        }
}

TEST(FindBoard, SeesBoardsTiltedBy60Degrees)
{
    Scene scene;
    scene.place = {turn_about(60, 0, 3), {0, 0, 520}};
    expect_found(scene, 0.15, "tilted about x");
    scene.place = {turn_about(0, -60, 3), {0, 0, 520}};
    expect_found(scene, 0.15, "tilted about y");
    scene.place = {turn_about(42, 42, 20), {0, 0, 480}};
    expect_found(scene, 0.15, "tilted about both");
}

TEST(FindBoard, SeesBlurredBoards)
{
    Scene scene;
    scene.place = {turn_about(15, -10, 5), {0, 0, 500}};
    scene.blur_px = 3.5;
    expect_found(scene, 0.3, "blur of 3.5 px");
    scene.blur_px = 6;
    expect_found(scene, 0.8, "blur of 6 px");
}

TEST(FindBoard, SeesPartlyDarkBoards)
{
    Scene scene;
    scene.place = {turn_about(10, 20, -5), {0, 0, 520}};
    scene.dark_part = 0.12;
    scene.noise = 1.5;
    expect_found(scene, 1.2, "left third dark"); // the border of the shadow bends the corners that it passes
}

TEST(FindBoard, SeesBoardsUnderTheEdgeOfAShadow)
{
    Scene scene;
    scene.shadow = 0.35;
    for (const double tilt : {-20.0, 0.0, 20.0}) {
        scene.place = {turn_about(10, tilt, -5), {0, 0, 520}};
        expect_found(scene, 4.5, "hard shadow across the board"); // a corner right on its edge moves
    }
}

TEST(FindBoard, SeesBoardsInDimLight)
{
    Scene scene;
    scene.place = {turn_about(10, 20, -5), {0, 0, 520}};
    scene.light = 0.08; // 15 grey levels between black and white
    scene.noise = 1.5;
    expect_found(scene, 0.6, "a twelfth of the light");
}

TEST(FindBoard, IsNotMovedByDirt)
{
    Scene scene;
    scene.place = {turn_about(10, -20, 4), {0, 0, 500}};
    scene.spots = 400;
    expect_found(scene, 0.8, "400 spots");
}

TEST(FindBoard, SeesBoardsInGlare)
{
    Scene scene;
    scene.place = {turn_about(-12, 8, 3), {0, 0, 520}};
    scene.glare = 205;
    scene.glare_at = {330, 220};
    scene.glare_px = 45;
    expect_found(scene, 0.5, "bright spot");
}

TEST(FindBoard, SeesNoisyAndPaleBoards)
{
    Scene scene;
    scene.place = {turn_about(20, 5, -8), {0, 0, 540}};
    scene.noise = 12;
    expect_found(scene, 0.6, "noise of 12 grey levels");
    scene.noise = 2;
    scene.white = 120;
    scene.black = 90;
    expect_found(scene, 0.6, "30 grey levels of contrast");
}

TEST(FindBoard, SeesBoardsAtTheBorderAndFarAway)
{
    Scene scene;
    scene.place = {turn_about(5, -5, 2), {-136, -80, 560}};
    expect_found(scene, 0.12, "first corner near the picture's corner");
    scene.place = {turn_about(10, 20, -3), {20, 10, 1600}};
    expect_found(scene, 0.2, "squares of 11 px");
}

TEST(FindBoard, SeesBoardsInLargeAndSmallPictures)
{
    Scene scene;
    scene.width = 2600;
    scene.height = 1950;
    scene.lens = {2400, 2400, 1299.5, 974.5, {}};
    scene.place = {turn_about(20, 15, 4), {0, 0, 560}};
    scene.blur_px = 2;
    expect_found(scene, 0.2, "5 megapixels");
    scene.width = 160;
    scene.height = 120;
    scene.lens = {150, 150, 79.5, 59.5, {}};
    scene.blur_px = 0.5;
    expect_found(scene, 0.2, "160 x 120");
}

TEST(FindBoard, SeesSquareBoardsWithEvenAndOddSides)
{
    for (const int side : {3, 7, 8, 9}) {
        Scene scene;
        scene.board = {side, side, 30};
        scene.place = {turn_about(15, -20, 6), {0, 0, 620}};
        expect_found(scene, 0.12, "square board");
    }
}

TEST(FindBoard, FollowsBentEdgesOfAWideLens)
{
    Scene scene;
    scene.lens = {330, 330, 319.5, 239.5, {-0.28, 0.07, 0.001, -0.001, 0}};
    scene.place = {turn_about(12, -15, 3), {0, 0, 260}};
    expect_found(scene, 0.2, "wide lens");
}

TEST(FindBoard, StartsAtTheUpperLeftAndKeepsTheBoardsHand)
{
    for (const double roll : {-35.0, 0.0, 35.0, 100.0, 180.0}) {
        Scene scene;
        scene.board = {7, 7, 30};
        scene.place = {turn_about(10, 5, roll), {0, 0, 560}};
        const Photo photo = test::photograph(scene);
        const BoardSight sight = find_board(photo.view(), scene.board);
        ASSERT_TRUE(sight.found) << sight.reason;
        const Point2 first = sight.corners.front();
        const Point2 along = sight.corners[6];
        const Point2 down = sight.corners[42];
        const double x = along.x - first.x, y = along.y - first.y;
        EXPECT_GT(x * (down.y - first.y) - y * (down.x - first.x), 0) << "mirrored at roll " << roll;
        EXPECT_GT(x, std::abs(y)) << "roll " << roll;
    }
}

TEST(FindBoard, SaysWhichSideOfTheBoardIsCutOff)
{
    Scene scene;
    scene.board = {9, 9, 30};
    scene.place = {turn_about(4, 3, 2), {0, -120, 560}};
    const BoardSight top = find_board(test::photograph(scene).view(), scene.board);
    EXPECT_FALSE(top.found);
    EXPECT_TRUE(top.corners.empty());
    EXPECT_THAT(top.reason, testing::ContainsRegex("[4-8] of 9 rows found; board cut off at the top"));
    scene.place.shift_mm = {260, 0, 640};
    EXPECT_THAT(find_board(test::photograph(scene).view(), scene.board).reason,
                testing::ContainsRegex("[4-8] of 9 columns found; board cut off on the right"));
}

TEST(FindBoard, SaysThatTheBoardIsAnotherOne)
{
    Scene scene;
    const Photo photo = test::photograph(scene);
    EXPECT_THAT(find_board(photo.view(), {8, 6, 30}).reason, testing::HasSubstr("at least"));
    EXPECT_THAT(find_board(photo.view(), {9, 5, 30}).reason, testing::HasSubstr("at least"));
    EXPECT_THAT(find_board(photo.view(), {10, 7, 30}).reason, testing::HasSubstr("6 of 7 rows and 9 of 10 columns"));
}

TEST(FindBoard, SaysThatCornersAreHidden)
{
    Scene scene;
    Photo photo = test::photograph(scene);
    for (int y = 190; y < 290; ++y)
        for (int x = 270; x < 370; ++x)
            photo.pixels[static_cast<std::size_t>(y * photo.width + x)] = 140;
    EXPECT_THAT(find_board(photo.view(), scene.board).reason,
                testing::ContainsRegex("of 54 corners found; the others are hidden"));
}

TEST(FindBoard, SaysWhatIsWrongWithThePicture)
{
    const Board board{9, 6, 30};
    const std::vector<std::uint8_t> one(1, 7);
    EXPECT_THAT(find_board({one.data(), 1, 1}, board).reason, testing::HasSubstr("too small"));
    EXPECT_THAT(find_board({}, board).reason, testing::HasSubstr("too small"));
    const std::vector<std::uint8_t> dark(640 * 480, 3);
    EXPECT_THAT(find_board({dark.data(), 640, 480}, board).reason, testing::HasSubstr("too dark"));
    const std::vector<std::uint8_t> bright(640 * 480, 255);
    EXPECT_THAT(find_board({bright.data(), 640, 480}, board).reason, testing::HasSubstr("overexposed"));
    std::vector<std::uint8_t> noise(640 * 480);
    std::mt19937 random(5);
    for (std::uint8_t& pixel : noise)
        pixel = static_cast<std::uint8_t>(random());
    EXPECT_THAT(find_board({noise.data(), 640, 480}, board).reason, testing::HasSubstr("no chessboard of 9 x 6"));
}

TEST(FindBoard, TakesThePictureThroughItsStride)
{
    const Scene scene;
    const Photo photo = test::photograph(scene);
    std::vector<std::uint8_t> wide(static_cast<std::size_t>(700 * photo.height), 99);
    for (int y = 0; y < photo.height; ++y)
        std::copy_n(photo.view().row(y), photo.width, wide.data() + 700 * y);
    const BoardSight plain = find_board(photo.view(), scene.board);
    const BoardSight strided = find_board({wide.data(), photo.width, photo.height, 700}, scene.board);
    ASSERT_TRUE(plain.found && strided.found);
    for (std::size_t k = 0; k < plain.corners.size(); ++k) {
        EXPECT_EQ(plain.corners[k].x, strided.corners[k].x);
        EXPECT_EQ(plain.corners[k].y, strided.corners[k].y);
    }
}

TEST(CheckBoard, RefusesBoardsThatCannotBe)
{
    EXPECT_TRUE(check_board({9, 6, 30}).ok());
    for (const Board& board : {Board{2, 6, 30}, Board{9, 61, 30}, Board{9, 6, 0}, Board{9, 6, -1}, Board{9, 6, NAN}})
        EXPECT_EQ(check_board(board).fault(), Fault::kUsage);
}

/// A board seen flat by a camera rolled by `roll`, in the order that find_board gives.
BoardSight rolled(const Board& board, double roll_deg)
{
    Scene scene;
    scene.board = board;
    scene.place = {turn_about(0, 0, roll_deg), {0, 0, 620}};
    BoardSight sight = find_board(test::photograph(scene).view(), board);
    EXPECT_TRUE(sight.found) << sight.reason;
    return sight;
}

TEST(AgreeOnOrder, LeavesOrdersThatAgree)
{
    const Board board{9, 9, 25};
    const BoardSight left = rolled(board, 2);
    BoardSight right = rolled(board, 3);
    const std::vector<Point2> before = right.corners;
    ASSERT_TRUE(agree_on_order(board, left, right).ok());
    for (std::size_t k = 0; k < before.size(); ++k)
        EXPECT_EQ(right.corners[k].x, before[k].x);
}

TEST(AgreeOnOrder, TurnsTheRightOneWhereTheUpperLeftRuleFlips)
{
    // At 45 degrees the two pictures start at different corners of a square board, at 90 degrees of an oblong one.
    for (const auto& [board, roll] : {std::pair{Board{9, 9, 25}, 45.0}, std::pair{Board{8, 8, 25}, 45.0},
                                      std::pair{Board{9, 7, 25}, 90.0}, std::pair{Board{9, 6, 25}, 90.0}}) {
        const BoardSight left = rolled(board, roll - 2);
        BoardSight right = rolled(board, roll + 2);
        ASSERT_GT(std::hypot(left.corners[0].x - right.corners[0].x, left.corners[0].y - right.corners[0].y), 100);
        const Status status = agree_on_order(board, left, right);
        ASSERT_TRUE(status.ok()) << status.message();
        for (std::size_t k = 0; k < left.corners.size(); ++k)
            EXPECT_LT(std::hypot(left.corners[k].x - right.corners[k].x, left.corners[k].y - right.corners[k].y), 25);
    }
}

TEST(AgreeOnOrder, ReadsTheOrderOfABoardWithOneEvenSideFromItsColours)
{
    const Board board{9, 6, 25};
    const BoardSight left = rolled(board, 0);
    BoardSight right = rolled(board, 180);
    ASSERT_TRUE(agree_on_order(board, left, right).ok());
    EXPECT_GT(right.corners.front().x, right.corners.back().x); // named from its lower right now
}

TEST(AgreeOnOrder, RefusesWhatCannotBeTold)
{
    const Board board{9, 7, 25}; // looks the same upside down
    const BoardSight left = rolled(board, 40);
    BoardSight right = rolled(board, -40); // 80 degrees apart: one turn is as likely as the other
    EXPECT_EQ(agree_on_order(board, left, right).fault(), Fault::kBadData);
    BoardSight inverse = rolled(board, 40);
    inverse.first_square_bright = !inverse.first_square_bright;
    EXPECT_THAT(agree_on_order(board, left, inverse).message(), testing::HasSubstr("colours"));
}

} // namespace
} // namespace dicot::calibration
