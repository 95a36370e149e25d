// Drawn scenes: ellipses of flat and folded blades above a bench, seen by a camera 400 mm above it.
#include "dicot/plant/canopy.h"
#include "dicot/plant/leaves.h"
#include "lent_arena.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <set>
#include <vector>

namespace dicot {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr double kFocalPx = 600, kCxPx = 320, kCyPx = 240, kHighMm = 400;
constexpr Rgb8 kBrown{120, 96, 70}, kGreen{70, 130, 50}, kWhite{240, 245, 240}, kLawn{80, 140, 60};
// 20 degrees down.
const double kUp[3] = {0, -std::cos(20 * M_PI / 180), -std::sin(20 * M_PI / 180)};

using Inside = std::function<bool(double, double)>;
/// Depth in mm along the ray (u, v, 1).
using Depth = std::function<double(double, double)>;

Inside ellipse(double x, double y, double half_width, double half_height)
{
    return [=](double column, double row) {
        const double a = (column - x) / half_width, b = (row - y) / half_height;
        return a * a + b * b <= 1;
    };
}

Inside box(double left, double top, double right, double bottom)
{
    return [=](double x, double y) { return x >= left && x <= right && y >= top && y <= bottom; };
}

/// The plane at `mm` in column and row of the middle that recedes by so many mm a px to the right and down.
Depth plane(double mm, double right, double down)
{
    return [=](double u, double v) { return mm / (1 - (right * u + down * v) * kFocalPx / mm); };
}

/// Points at a height above the bench.
Depth level(double height_mm)
{
    return [=](double u, double v) {
        const double down = -(kUp[0] * u + kUp[1] * v + kUp[2]);
        return down > 0 ? (kHighMm - height_mm) / down : 1e9;
    };
}

struct alignas(Arena::kAlignment) Line
{
    std::byte bytes[Arena::kAlignment];
};

class Scene
{
public:
    Scene() : mm_(kPixels, 1e9), colour_(kPixels), name_(kPixels, 0)
    {
        paint(0, box(0, 0, kWidth, kHeight), level(0), kBrown);
    }

    /// Nothing is there, nor is the bench.
    Scene& clear()
    {
        std::ranges::fill(mm_, 1e9);
        return *this;
    }

    /// What is nearer hides what is farther.
    Scene& paint(int name, const Inside& inside, const Depth& depth, Rgb8 colour = kGreen)
    {
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const std::size_t i = static_cast<std::size_t>(y * kWidth + x);
                const double mm = inside(x, y) ? depth((x - kCxPx) / kFocalPx, (y - kCyPx) / kFocalPx) : 1e9;
                if (mm < mm_[i]) {
                    mm_[i] = mm;
                    colour_[i] = colour;
                    name_[i] = name;
                }
            }
        return *this;
    }

    /// With noise of 0.3 mm at 600 mm.
    const Scene& look(std::span<const PlantBox> boxes = {})
    {
        std::mt19937 random(3);
        points_.clear();
        names_.clear();
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const std::size_t i = static_cast<std::size_t>(y * kWidth + x);
                const double noise = (static_cast<double>(random() % 1000) / 1000 - 0.5) * 1e-3;
                const double z = mm_[i] * (1 + noise);
                if (mm_[i] > 1300)
                    continue;
                const auto steps = [](double mm) { return static_cast<std::int32_t>(std::lround(mm * 10)); };
                points_.push_back(
                    {steps((x - kCxPx) / kFocalPx * z), steps((y - kCyPx) / kFocalPx * z), steps(z), colour_[i], 200});
                names_.push_back(name_[i]);
            }
        view_memory_.resize((std::size_t{kPixels} * 4 + (1 << 20)) / sizeof(Line));
        Arena arena{std::as_writable_bytes(std::span{view_memory_})};
        const PointCloud cloud{points_, {}};
        view = plant_view(cloud, arena).value();
        memory_.resize(segment_leaves_bytes(view) / sizeof(Line) + 1);
        Arena table{std::as_writable_bytes(std::span{memory_})};
        auto found = segment_leaves(view, boxes, table);
        EXPECT_TRUE(found.ok());
        leaves = found.value();
        return *this;
    }

    /// The number that most points of `name` have, as leaf.
    int leaf_of(int name) const
    {
        return most(name, [&](std::size_t i) { return int{leaves.leaf[i]}; });
    }
    int plant_of(int name) const
    {
        return most(name, [&](std::size_t i) { return int{leaves.plant[i]}; });
    }

    /// Points that both have, by points that one of them has.
    double overlap(int name) const
    {
        const int leaf = leaf_of(name);
        double both = 0, either = 0;
        for (std::size_t i = 0; i < names_.size(); ++i) {
            both += names_[i] == name && leaves.leaf[i] == leaf;
            either += names_[i] == name || leaves.leaf[i] == leaf;
        }
        return both / either;
    }

    PlantView view;
    Leaves leaves;

private:
    static constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

    template <typename Number>
    int most(int name, const Number& number) const
    {
        std::vector<int> count(1 << 16);
        for (std::size_t i = 0; i < names_.size(); ++i)
            if (names_[i] == name)
                ++count[static_cast<std::size_t>(number(i))];
        return static_cast<int>(std::max_element(count.begin(), count.end()) - count.begin());
    }

    std::vector<double> mm_;
    std::vector<Rgb8> colour_;
    std::vector<int> name_;
    std::vector<CloudPoint> points_;
    std::vector<int> names_; ///< of the points
    std::vector<Line> view_memory_, memory_;
};

TEST(Ground, IsTheBenchSeenFromAboveItsPlane)
{
    Scene scene;
    scene.paint(1, ellipse(320, 200, 60, 40), plane(600, 0.1, 0));
    const GroundFrame ground = scene.look().leaves.ground;
    ASSERT_EQ(ground.kind, GroundFrame::Kind::kBench);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(ground.up[axis], kUp[axis], 5e-4);
        EXPECT_NEAR(ground.origin_mm[axis], -kHighMm * kUp[axis], 0.5);
    }
    const double right[3] = {1, 0, 0};
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(ground.right[axis], right[axis], 5e-4);
    EXPECT_LT(ground.rms_mm, 1);
}

/// A plane at 600 mm that recedes by `lean` mm a mm downwards in the picture; discs 80 mm before it, at these places.
Scene facing(double lean, const std::vector<std::pair<double, double>>& discs)
{
    Scene scene;
    scene.clear().paint(0, box(0, 0, kWidth, kHeight), plane(600, 0, lean * 600 / kFocalPx), kBrown);
    for (std::size_t i = 0; i < discs.size(); ++i)
        scene.paint(static_cast<int>(i) + 1, ellipse(discs[i].first, discs[i].second, 60, 60), plane(520, 0, 0));
    return scene;
}

TEST(Ground, IsWhatACameraLooksStraightDownAt)
{
    for (const double lean : {-0.3, 0.0, 0.3}) { // 17 degrees to either side
        Scene scene = facing(lean, {{200, 160}, {420, 300}});
        const GroundFrame ground = scene.look().leaves.ground;
        ASSERT_EQ(ground.kind, GroundFrame::Kind::kBench) << lean;
        const double slope = std::sqrt(1 + lean * lean);
        const double up[3] = {0, lean / slope, -1 / slope}, away[3] = {0, -1 / slope, -lean / slope};
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(ground.up[axis], up[axis], 2e-3) << lean;
            EXPECT_NEAR(ground.away[axis], away[axis], 2e-3) << lean;
            EXPECT_NEAR(ground.origin_mm[axis], -600 / slope * up[axis], 1.5) << lean;
        }
        EXPECT_NEAR(ground.right[0], 1, 2e-3);
        EXPECT_EQ(scene.leaves.plant_count, 1);
        EXPECT_GT(scene.overlap(1), 0.9);
    }
    // Plants all over the picture cross both edges.
    Scene dense = facing(0, {{100, 20}, {330, 30}, {200, 240}, {120, 460}, {400, 450}});
    EXPECT_EQ(dense.look().leaves.ground.kind, GroundFrame::Kind::kBench);
}

TEST(Ground, IsNoWallThatPlantsStandBefore)
{
    Scene scene = facing(0, {{320, 250}});
    scene.paint(2, box(220, 290, 420, kHeight), plane(510, 0, 0), kBrown); // its pot stands on what is not seen
    EXPECT_EQ(scene.look().leaves.ground.kind, GroundFrame::Kind::kNone);
}

TEST(Ground, MovesUpToTheSoilOfAPot)
{
    Scene scene;
    scene.paint(0, ellipse(320, 330, 90, 40), level(110), {60, 45, 35})
        .paint(1, ellipse(320, 220, 60, 40), plane(620, 0, 0.2));
    const GroundFrame ground = scene.look().leaves.ground;
    EXPECT_EQ(ground.kind, GroundFrame::Kind::kSoil);
    EXPECT_NEAR(ground.bench_mm, -110, 1);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(ground.origin_mm[axis], -(kHighMm - 110) * kUp[axis], 1.5);
}

TEST(Ground, GreenLawnIsNoCanopy)
{
    Scene scene;
    scene.paint(0, box(0, 0, kWidth, kHeight), level(1), kLawn).paint(1, ellipse(320, 200, 60, 40), plane(600, 0.1, 0));
    scene.look();
    EXPECT_EQ(scene.leaves.plant_count, 1);
    EXPECT_EQ(scene.leaves.leaf_count, 1);
    EXPECT_GT(scene.overlap(1), 0.97);
}

TEST(Ground, NothingGreenIsNoPlant)
{
    Scene scene;
    scene.look();
    EXPECT_EQ(scene.leaves.plant_count, 0);
    EXPECT_EQ(scene.leaves.leaf_count, 0);
}

TEST(Canopy, AWaxyLeafIsOfItAndAPrintOfTheSameColourIsNot)
{
    constexpr Rgb8 kWaxy{134, 165, 128}; // an aloe's, in the shade
    Scene scene;
    scene.paint(1, ellipse(250, 160, 70, 45), plane(600, 0.1, 0.2))
        .paint(2, ellipse(400, 170, 50, 45), plane(610, -0.1, 0.1), kWaxy)
        .paint(3, box(250, 330, 420, 470), plane(570, 0, 0), kBrown)
        .paint(4, ellipse(335, 400, 50, 40), plane(569.99, 0, 0), kWaxy);
    scene.look();
    EXPECT_GT(scene.overlap(1), 0.97);
    EXPECT_GT(scene.overlap(2), 0.97);
    EXPECT_EQ(scene.leaf_of(4), Leaves::kNone);
    EXPECT_EQ(scene.leaves.leaf_count, 2);
}

TEST(Canopy, ABluishGreenPotIsNotOfIt)
{
    constexpr Rgb8 kPot{45, 68, 64};
    Scene scene;
    scene.paint(1, ellipse(320, 160, 70, 45), plane(600, 0.1, 0.2))
        .paint(2, ellipse(320, 330, 60, 60), plane(560, 0, 0), kPot);
    scene.look();
    EXPECT_EQ(scene.leaf_of(2), Leaves::kNone);
    EXPECT_EQ(scene.leaves.leaf_count, 1);
}

TEST(Leaves, OneOverTheOtherAreTwo)
{
    Scene scene;
    scene.paint(1, ellipse(300, 200, 70, 45), plane(640, 0.1, 0.2))
        .paint(2, ellipse(350, 220, 70, 45), plane(615, -0.1, 0.1));
    scene.look();
    EXPECT_EQ(scene.leaves.leaf_count, 2);
    EXPECT_GT(scene.overlap(1), 0.95);
    EXPECT_GT(scene.overlap(2), 0.95);
}

TEST(Leaves, TwoThatTouchAreTwo)
{
    Scene scene;
    // The contact is 15 px long, in front of the bench.
    scene.paint(1, ellipse(260, 340, 60, 40), plane(620, 0.1, 0.2))
        .paint(2, ellipse(378, 340, 60, 40), plane(620, 0.3, 0.2));
    scene.look();
    EXPECT_EQ(scene.leaves.leaf_count, 2);
    EXPECT_GT(scene.overlap(1), 0.95);
    EXPECT_GT(scene.overlap(2), 0.95);
}

TEST(Leaves, ABladeFoldedAtItsMidribIsOne)
{
    Scene scene;
    const Depth fold = [](double u, double v) {
        return u < 0 ? plane(620, 0.6, 0.1)(u, v) : plane(620, -0.6, 0.1)(u, v);
    };
    scene.paint(1, ellipse(320, 200, 60, 90), fold);
    scene.look();
    EXPECT_EQ(scene.leaves.leaf_count, 1);
    EXPECT_GT(scene.overlap(1), 0.95);
}

TEST(Leaves, AStemInFrontCutsNoBladeInTwo)
{
    Scene scene;
    scene.paint(1, ellipse(320, 200, 80, 50), plane(640, 0.2, 0.1)).paint(2, box(322, 100, 330, 330), plane(560, 0, 0));
    scene.look();
    EXPECT_GT(scene.overlap(1), 0.95);
}

TEST(Leaves, APetioleJoinsNoBlades)
{
    Scene scene;
    scene.paint(1, ellipse(230, 200, 60, 40), plane(620, 0, 0))
        .paint(2, ellipse(410, 200, 60, 40), plane(620, 0, 0))
        .paint(3, box(280, 197, 360, 203), plane(620, 0, 0));
    scene.look();
    EXPECT_NE(scene.leaf_of(1), scene.leaf_of(2));
    EXPECT_GT(scene.overlap(1), 0.9);
    EXPECT_GT(scene.overlap(2), 0.9);
}

TEST(Leaves, EndWhereTheirPetioleGoesOn)
{
    Scene scene;
    scene.paint(1, ellipse(320, 120, 45, 30), plane(620, 0, 0)).paint(2, box(316, 146, 324, 390), plane(620, 0, 0));
    scene.look();
    // Two half widths of the petiole may stay: 8 x 66 px of a blade of 4240.
    EXPECT_GT(scene.overlap(1), 0.85);
    EXPECT_NE(scene.leaf_of(2), scene.leaf_of(1));
}

TEST(Leaves, AHighlightIsOfItsBlade)
{
    Scene scene;
    const Depth blade = plane(620, 0.2, 0.1);
    scene.paint(1, ellipse(320, 200, 80, 50), blade)
        .paint(
            1, ellipse(330, 190, 8, 5), [&](double u, double v) { return blade(u, v) - 0.01; }, kWhite);
    scene.look();
    EXPECT_EQ(scene.leaves.leaf_count, 1);
    EXPECT_GT(scene.overlap(1), 0.99);
}

TEST(Leaves, AreNeitherPaleStemsNorAGreenishPot)
{
    Scene scene;
    // Of one light; a pot whose glaze passes for green.
    constexpr Rgb8 kStem{100, 138, 70}, kGlaze{62, 90, 74};
    scene.paint(1, ellipse(230, 150, 70, 45), plane(620, 0.1, 0.3))
        .paint(2, ellipse(410, 150, 70, 45), plane(620, -0.1, 0.3))
        .paint(3, box(315, 120, 325, 330), plane(640, 0, 0), kStem)
        .paint(4, box(260, 345, 380, 385), plane(640, 0, 0), kGlaze);
    scene.look();
    EXPECT_NE(scene.leaf_of(1), 0);
    EXPECT_NE(scene.leaf_of(2), 0);
    EXPECT_EQ(scene.leaf_of(3), 0);
    EXPECT_EQ(scene.leaf_of(4), 0);
    EXPECT_EQ(scene.plant_of(3), 1);
}

TEST(Leaves, MayBeNarrow)
{
    Scene scene;
    // Blades of grass: one is paler than the others.
    for (int name = 1; name <= 6; ++name)
        scene.paint(name, ellipse(100 + 70 * name, 200, 7, 120), plane(620, 0.1, 0.2),
                    name == 3 ? Rgb8{96, 138, 66} : kGreen);
    scene.look();
    EXPECT_EQ(scene.leaves.leaf_count, 6);
}

TEST(Plants, AreToldApartByGapsAndNumberedFromLeftToRight)
{
    Scene scene;
    scene.paint(1, ellipse(480, 200, 50, 40), plane(600, 0, 0)).paint(2, ellipse(160, 200, 50, 40), plane(600, 0, 0));
    scene.look();
    EXPECT_EQ(scene.leaves.plant_count, 2);
    EXPECT_EQ(scene.plant_of(2), 1);
    EXPECT_EQ(scene.plant_of(1), 2);
    EXPECT_EQ(scene.leaf_of(2), 1);
    EXPECT_EQ(scene.leaf_of(1), 2);
    EXPECT_EQ(scene.leaves.plant_of_leaf[1], 2);
}

TEST(Plants, AreWhatStandsInBoxes)
{
    Scene scene;
    scene.paint(1, ellipse(480, 200, 50, 40), plane(600, 0, 0))
        .paint(2, ellipse(160, 200, 50, 40), plane(600, 0, 0))
        .paint(3, ellipse(320, 200, 50, 40), plane(600, 0, 0));
    const PlantBox boxes[] = {{{60, 0, -1000}, {400, 2000, 1000}}, {{-400, 0, -1000}, {-60, 2000, 1000}}};
    scene.look(boxes);
    EXPECT_EQ(scene.leaves.plant_count, 2);
    EXPECT_EQ(scene.plant_of(1), 1);
    EXPECT_EQ(scene.plant_of(2), 2);
    EXPECT_EQ(scene.plant_of(3), 0);
    EXPECT_EQ(scene.leaf_of(3), 0);
}

TEST(Plants, AreFoundInTheirBoxesHoweverSmall)
{
    Scene scene;
    scene.paint(1, ellipse(480, 200, 60, 50), plane(600, 0, 0)).paint(2, ellipse(160, 200, 16, 12), plane(600, 0, 0));
    scene.look();
    EXPECT_EQ(scene.leaves.plant_count, 1);
    EXPECT_EQ(scene.plant_of(2), 0);
    const PlantBox boxes[] = {{{60, 0, -1000}, {400, 2000, 1000}}, {{-400, 0, -1000}, {-60, 2000, 1000}}};
    scene.look(boxes);
    EXPECT_EQ(scene.plant_of(1), 1);
    EXPECT_EQ(scene.plant_of(2), 2);
}

TEST(Plants, LeaveOutWhatHangsInTheAirAboveThem)
{
    Scene scene;
    // The second is 200 mm straight up from the first.
    scene.paint(1, ellipse(320, 330, 90, 55), plane(620, 0, 0)).paint(2, ellipse(320, 137, 14, 10), plane(552, 0, 0));
    scene.look();
    EXPECT_EQ(scene.leaves.plant_count, 1);
    EXPECT_EQ(scene.plant_of(1), 1);
    EXPECT_EQ(scene.plant_of(2), 0);
}

TEST(Leaves, AreRefusedWithTooLittleMemory)
{
    Scene scene;
    scene.paint(1, ellipse(320, 200, 60, 40), plane(600, 0.1, 0));
    scene.look();
    std::vector<Line> small(1000);
    for (std::size_t lines = 1; lines <= small.size(); lines *= 10) {
        Arena arena{std::as_writable_bytes(std::span{small.data(), lines})};
        const auto refused = segment_leaves(scene.view, {}, arena);
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(refused.status().fault(), Fault::kConfig);
    }
}

TEST(Leaves, FitTheStatedMemoryWhereManyPointsShareAPixel)
{
    std::vector<CloudPoint> points;
    for (int column = 0; column < 750; ++column)
        points.insert(points.end(), 2000, {column * 10, 0, 6000, kGreen, 200});
    test::LentArena grid(PlantView::kMostCells * sizeof(std::int32_t) + (std::size_t{1} << 20));
    const PlantView view = plant_view({points, {100, 14, {0, 0, 0}}}, grid.arena()).value();
    ASSERT_FALSE(view.too_few);
    ASSERT_LT(view.point.width * view.point.height, 2000);
    test::LentArena table(segment_leaves_bytes(view));
    EXPECT_TRUE(segment_leaves(view, {}, table.arena()).ok());
    EXPECT_LE(table.arena().peak(), segment_leaves_bytes(view));
}

} // namespace
} // namespace dicot
