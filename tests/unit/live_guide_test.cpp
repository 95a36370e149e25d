// Synthetic boards before a known rig: what the guide of a live calibration makes of them.
#include "live/live_guide.h"
#include "rig_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dicot::app {
namespace {

using calibration::Board;
using calibration::BoardSight;
using calibration::Stance;
using test::Placement;
using test::turn_about;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr Board kBoard{9, 6, 30};
constexpr calibration::WorkingRange kRange{400, 1200};

/// 640 x 480 px, lenses without distortion, 60 mm apart.
StereoRig straight_rig()
{
    StereoRig rig;
    rig.width = 640;
    rig.height = 480;
    rig.left = {560, 560, 319.5, 239.5, {}};
    rig.right = rig.left;
    rig.shift_mm = {-60, 0, 0};
    return rig;
}

BoardSight sight_of(std::vector<Point2> corners)
{
    BoardSight sight;
    sight.found = true;
    sight.corners = std::move(corners);
    sight.first_square_bright = true;
    return sight;
}

BoardSight unseen(const char* reason)
{
    BoardSight sight;
    sight.reason = reason;
    return sight;
}

/// Tilted about x and y, its middle there in the left camera's frame.
Placement placed(double tilt_x, double tilt_y, double x, double y, double z)
{
    return {turn_about(tilt_x, tilt_y, 0), {x, y, z}};
}

/// A person before the rig: holds boards still or not, 10 pairs a second.
struct Stage
{
    StereoRig rig = straight_rig();
    LiveGuide guide;
    std::int64_t now_us = 1'000'000;

    explicit Stage(int pairs, const calibration::WorkingRange& range = kRange) : guide(kBoard, 640, 480, range, pairs)
    {
    }

    LiveSight show(const Placement& place)
    {
        now_us += 100'000;
        return guide.see(sight_of(test::board_corners(kBoard, place, rig.left)),
                         sight_of(test::board_corners(kBoard, test::in_right(rig, place), rig.right)), now_us);
    }
    /// Holds still for a second, or until the pair is taken.
    LiveSight hold(const Placement& place)
    {
        LiveSight sight = LiveSight::kMoving;
        for (int k = 0; k < 10 && sight != LiveSight::kTake; ++k)
            sight = show(place);
        if (sight == LiveSight::kTake)
            guide.keep();
        return sight;
    }
};

TEST(Stance, TellsDistancePlaceAndTiltOfABoardBeforeAKnownLens)
{
    const Lens lens = straight_rig().left;
    struct Case
    {
        double tilt_x, tilt_y, x, y, z;
        double slope_x, slope_y; // by hand: what of the depth rises along the picture's x and y
    };
    const double tan20 = std::tan(20 * std::numbers::pi / 180);
    const double tan35 = std::tan(35 * std::numbers::pi / 180);
    for (const Case& c :
         {Case{0, 0, 0, 0, 600, 0, 0}, Case{0, 20, 50, -30, 500, -tan20, 0}, Case{0, -20, -50, 30, 900, tan20, 0},
          Case{35, 0, 0, 40, 700, 0, tan35}, Case{-35, 0, 80, 0, 1100, 0, -tan35}}) {
        const Stance stance = calibration::stance_of(
            kBoard, test::board_corners(kBoard, placed(c.tilt_x, c.tilt_y, c.x, c.y, c.z), lens), 640, 480, 560);
        EXPECT_NEAR(stance.distance_mm, c.z, 0.01);
        EXPECT_NEAR(stance.slope.x, c.slope_x, 1e-4);
        EXPECT_NEAR(stance.slope.y, c.slope_y, 1e-4);
        // The mean of a tilted board's corners is not its middle, but near it.
        EXPECT_NEAR(stance.place.x, (560 * c.x / c.z + 320) / 640, 0.02);
        EXPECT_NEAR(stance.place.y, (560 * c.y / c.z + 240) / 480, 0.02);
    }
}

TEST(Stance, FindsTheFocalLengthOfADistortedLensWithin5Percent)
{
    const calibration::CalibrationTask task = test::varied_task(test::webcam_rig(), kBoard, 12, 0.1, 7);
    std::vector<std::vector<Point2>> sights;
    for (const calibration::View& view : task.views)
        sights.push_back(view.left);
    const double focal_px = calibration::guess_focal_px(kBoard, sights, 1280, 720);
    std::printf("focal length: %.1f px for 781 px\n", focal_px);
    EXPECT_NEAR(focal_px, 781, 0.05 * 781);
}

TEST(Stance, TakesACommonWebcamsFocalLengthBeforeFourBoards)
{
    const std::vector<std::vector<Point2>> three(
        3, test::board_corners(kBoard, placed(20, 10, 0, 0, 600), straight_rig().left));
    EXPECT_EQ(calibration::guess_focal_px(kBoard, three, 640, 480), 0.85 * 640);
}

TEST(Glance, PutsCornersOfALargePictureWhereTheThoroughSearchDoes)
{
    test::Scene scene;
    scene.width = 1280;
    scene.height = 960;
    scene.lens = {1100, 1100, 639.5, 479.5, {}};
    scene.place = placed(15, -20, 20, 10, 700);
    const test::Photo photo = test::photograph(scene);
    const BoardSight quick = calibration::glance(photo.view(), scene.board);
    const BoardSight thorough = calibration::find_board(photo.view(), scene.board);
    ASSERT_TRUE(quick.found) << quick.reason;
    ASSERT_TRUE(thorough.found) << thorough.reason;
    EXPECT_NEAR(quick.square_px, thorough.square_px, 0.1);
    for (std::size_t k = 0; k < quick.corners.size(); ++k) {
        EXPECT_NEAR(quick.corners[k].x, thorough.corners[k].x, 0.2);
        EXPECT_NEAR(quick.corners[k].y, thorough.corners[k].y, 0.2);
    }
}

TEST(Glance, SeesABoardThatIsTooSmallAtHalfTheSize)
{
    test::Scene scene;
    scene.width = 1280;
    scene.height = 960;
    scene.lens = {1100, 1100, 639.5, 479.5, {}};
    scene.board = {20, 15, 30};
    scene.place = placed(10, 10, 0, 0, 2700); // squares of 12 px
    EXPECT_TRUE(calibration::glance(test::photograph(scene).view(), scene.board).found);
}

TEST(Stillness, IsHalfASecondOfThreePairsWithinHalfAPixel)
{
    struct Seen
    {
        std::int64_t at_ms;
        double left_px; // where the last corner is, along x
        double right_px;
        bool still;
    };
    const std::vector<std::pair<const char*, std::vector<Seen>>> cases{
        {"nothing moves",
         {{0, 0, 0, false}, {200, 0, 0, false}, {400, 0, 0, false}, {500, 0, 0, true}, {600, 0, 0, true}}},
        {"two pairs are not enough", {{0, 0, 0, false}, {700, 0, 0, false}, {1400, 0, 0, true}}},
        {"a tremor within the circle", {{0, 0, 0, false}, {300, 0.4, -0.4, false}, {600, -0.4, 0.4, true}}},
        {"the left one moves", {{0, 0, 0, false}, {300, 0, 0, false}, {600, 0.6, 0, false}, {900, 0.6, 0, false}}},
        {"the right one moves", {{0, 0, 0, false}, {300, 0, 0, false}, {600, 0, 0.6, false}, {900, 0, 0.6, false}}},
        {"a slow drift is no rest",
         {{0, 0, 0, false}, {300, 0.3, 0, false}, {600, 0.6, 0, false}, {900, 0.9, 0, false}, {1200, 1.2, 0, false}}},
        {"a long gap", {{0, 0, 0, false}, {300, 0, 0, false}, {10400, 0, 0, false}, {10700, 0, 0, false}}},
        {"cameras in turn", {{0, 0, 0, false}, {4000, 0, 0, false}, {8000, 0, 0, true}}},
        {"time that goes back", {{900, 0, 0, false}, {1200, 0, 0, false}, {300, 0, 0, false}, {700, 0, 0, false}}},
    };
    for (const auto& [what, pairs] : cases) {
        Stillness stillness(640, 2);
        for (const Seen& seen : pairs) {
            const std::vector<Point2> left{{1, 2}, {100 + seen.left_px, 50}};
            const std::vector<Point2> right{{1, 2}, {90 + seen.right_px, 50}};
            EXPECT_EQ(stillness.see(left, right, seen.at_ms * 1000), seen.still) << what << " at " << seen.at_ms;
        }
    }
}

TEST(Stillness, GivesAWidePictureAWiderCircle)
{
    for (const auto& [width, still] : {std::pair{640, false}, std::pair{1280, true}}) {
        Stillness stillness(width, 1);
        bool last = false;
        for (int k = 0; k < 4; ++k)
            last = stillness.see(std::vector<Point2>{{0.8 * (k % 2), 0}}, std::vector<Point2>{{0, 0}}, 300'000 * k);
        EXPECT_EQ(last, still) << width;
    }
}

TEST(LiveGuide, TakesABoardThatStandsStillAndTheSameOneNeverTwice)
{
    Stage stage(5);
    const Placement first = placed(20, 0, 0, 0, 600);
    EXPECT_EQ(stage.hold(first), LiveSight::kTake);
    EXPECT_EQ(stage.hold(first), LiveSight::kAlike);
    EXPECT_THAT(stage.guide.advice(), HasSubstr("as in pair 1"));
    // A little further is still the same, far enough is not.
    EXPECT_EQ(stage.hold(placed(22, 3, 10, 5, 620)), LiveSight::kAlike);
    for (const Placement& other : {placed(20, 0, 120, 0, 600), placed(20, 0, 0, 0, 800), placed(-5, 0, 0, 0, 600)})
        EXPECT_EQ(stage.hold(other), LiveSight::kTake) << stage.guide.advice();
    EXPECT_EQ(stage.guide.kept(), 4);
    EXPECT_FALSE(stage.guide.done());
    EXPECT_EQ(stage.hold(placed(20, 30, 0, 0, 600)), LiveSight::kTake);
    EXPECT_TRUE(stage.guide.done());
}

TEST(LiveGuide, NeverTakesABoardInMotion)
{
    Stage stage(5);
    for (int k = 0; k < 60; ++k) {
        EXPECT_EQ(stage.show(placed(10, 0, -100 + 2.0 * k, 0, 600)), LiveSight::kMoving);
        EXPECT_THAT(stage.guide.advice(), testing::StartsWith("hold still"));
    }
}

TEST(LiveGuide, BeginsAnewWhenTheBoardWasAway)
{
    Stage stage(5);
    const Placement place = placed(20, 0, 0, 0, 600);
    for (int k = 0; k < 4; ++k)
        EXPECT_EQ(stage.show(place), LiveSight::kMoving);
    stage.now_us += 100'000;
    EXPECT_EQ(stage.guide.see(unseen("it is dark"), unseen("it is dark"), stage.now_us), LiveSight::kUnseen);
    for (int k = 0; k < 5; ++k)
        EXPECT_EQ(stage.show(place), LiveSight::kMoving) << k;
    EXPECT_EQ(stage.show(place), LiveSight::kTake);
}

TEST(LiveGuide, NamesTheCameraThatDoesNotSeeTheBoard)
{
    Stage stage(5);
    const BoardSight seen = sight_of(test::board_corners(kBoard, placed(0, 0, 0, 0, 600), stage.rig.left));
    EXPECT_EQ(stage.guide.see(seen, unseen("cut off at the left"), 1), LiveSight::kRightUnseen);
    EXPECT_THAT(stage.guide.advice(), AllOf(HasSubstr("the right camera"), HasSubstr("cut off at the left")));
    EXPECT_EQ(stage.guide.see(unseen("cut off at the right"), seen, 2), LiveSight::kLeftUnseen);
    EXPECT_THAT(stage.guide.advice(), AllOf(HasSubstr("the left camera"), HasSubstr("cut off at the right")));
    EXPECT_EQ(stage.guide.see(unseen("dark"), unseen("dark"), 3), LiveSight::kUnseen);
    EXPECT_THAT(stage.guide.advice(), HasSubstr("both cameras"));
}

TEST(LiveGuide, SaysThatColoursDisagree)
{
    const Board even{8, 6, 30}; // looks the same after half a turn, colours and all
    LiveGuide guide(even, 640, 480, kRange, 5);
    const BoardSight bright = sight_of(test::board_corners(even, placed(0, 0, 0, 0, 600), straight_rig().left));
    BoardSight dark = bright;
    dark.first_square_bright = false;
    EXPECT_EQ(guide.see(bright, dark, 1), LiveSight::kUnclear);
    EXPECT_THAT(guide.advice(), HasSubstr("colours"));
}

TEST(NextPlace, NamesDistancePartAndEdgeThatAreMissing)
{
    LiveCoverage all;
    all.left.corners.fill(1);
    all.right.corners.fill(1);
    all.by_distance = {1, 1, 1};
    all.by_edge = {1, 1, 1, 1};
    ASSERT_TRUE(all.full());
    EXPECT_THAT(next_place(all, kRange, {}), HasSubstr("elsewhere"));
    const Stance far{{0.5, 0.5}, 1000, {}};

    LiveCoverage near = all;
    near.by_distance[0] = 0;
    EXPECT_FALSE(near.full());
    EXPECT_EQ(next_place(near, kRange, far), "nearer (400 to 667 mm, now about 1000 mm)");
    EXPECT_EQ(next_place(near, kRange, {}), "at 400 to 667 mm");
    EXPECT_EQ(next_place(near, kRange, Stance{{}, 500, {}}), "as far away as it is");
    LiveCoverage distant = all;
    distant.by_distance[2] = 0;
    EXPECT_EQ(next_place(distant, kRange, Stance{{}, 500, {}}), "farther (933 to 1200 mm, now about 500 mm)");

    LiveCoverage corner = all;
    for (const std::size_t row : {4U, 5U})
        std::fill_n(corner.left.corners.begin() + static_cast<std::ptrdiff_t>(8 * row), 3, 0);
    EXPECT_FALSE(corner.full());
    EXPECT_EQ(next_place(corner, kRange, far), "at the lower left of the left picture");
    LiveCoverage other = all;
    for (const std::size_t row : {0U, 1U})
        std::fill_n(other.right.corners.begin() + static_cast<std::ptrdiff_t>(8 * row + 5), 3, 0);
    EXPECT_FALSE(other.full());
    EXPECT_EQ(next_place(other, kRange, far), "at the upper right of the right picture");

    constexpr std::array<const char*, 4> kWords{"with its left edge nearer to the cameras than its right one",
                                                "with its right edge nearer to the cameras than its left one",
                                                "with its upper edge nearer to the cameras than its lower one",
                                                "with its lower edge nearer to the cameras than its upper one"};
    for (std::size_t edge = 0; edge < kWords.size(); ++edge) {
        LiveCoverage tilt = all;
        tilt.by_edge[edge] = 0;
        EXPECT_FALSE(tilt.full());
        EXPECT_EQ(next_place(tilt, kRange, far), kWords[edge]);
    }
}

TEST(LiveGuide, CountsTheTiltsAndDistancesOfTheBoardsThatWereHeld)
{
    Stage stage(20);
    // A board turned about y by +25 degrees has its right edge nearer, about x by +25 degrees its upper one.
    ASSERT_EQ(stage.hold(placed(0, 25, 0, 0, 500)), LiveSight::kTake);
    ASSERT_EQ(stage.hold(placed(25, 0, 0, 0, 820)), LiveSight::kTake);
    ASSERT_EQ(stage.hold(placed(0, 0, 100, 50, 820)), LiveSight::kTake);
    EXPECT_THAT(stage.guide.coverage().by_edge, testing::ElementsAre(0, 1, 1, 0));
    EXPECT_THAT(stage.guide.coverage().by_distance, testing::ElementsAre(1, 2, 0));
    EXPECT_THAT(stage.guide.coverage().left.share, testing::AllOf(testing::Gt(0.1), testing::Lt(0.6)));
}

TEST(LiveGuide, ComesToFullCoverageOfAVariedSet)
{
    const StereoRig rig = test::webcam_rig();
    const calibration::CalibrationTask task = test::varied_task(rig, kBoard, 60, 0.05, 11);
    LiveGuide guide(kBoard, rig.width, rig.height, kRange, 60);
    std::int64_t now_us = 0;
    int full_at = 0;
    for (const calibration::View& view : task.views) {
        for (int k = 0; k < 8; ++k)
            if (guide.see(sight_of(view.left), sight_of(view.right), now_us += 100'000) == LiveSight::kTake)
                guide.keep();
        if (full_at == 0 && guide.coverage().full())
            full_at = guide.kept();
    }
    std::printf("full after %d pairs, %d of 60 kept (seed 11)\n", full_at, guide.kept());
    EXPECT_GE(full_at, 7);  // one pair cannot fill three distances and four tilts of nine parts
    EXPECT_LE(full_at, 40); // places at random
    EXPECT_GE(guide.kept(), 45);
    EXPECT_LE(guide.kept(), 60);
    EXPECT_THAT(guide.advice(), Not(testing::IsEmpty()));
}

} // namespace
} // namespace dicot::app
