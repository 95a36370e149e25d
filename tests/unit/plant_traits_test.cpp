// Leaves drawn from formulas, whose lengths, areas and angles are known.
#include "lent_arena.h"

#include "dicot/plant/convex_hull.h"
#include "dicot/plant/traits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

namespace dicot {
namespace {

constexpr double kFocal_px = 800, kDegree = std::numbers::pi / 180;

/// What is drawn, pixel by pixel: the depth of each leaf, the nearest wins.
class Drawn
{
public:
    static constexpr int kWidth = 320, kHeight = 240;

    Drawn() : leaf_at_(kWidth * kHeight, 0), z_mm_(leaf_at_.size(), std::numeric_limits<double>::infinity()) {}

    /// `depth_mm` of a ray (x, y, 1); infinite where it misses.
    void leaf(int number, const std::function<double(double x, double y)>& depth_mm)
    {
        for (int row = 0; row < kHeight; ++row)
            for (int column = 0; column < kWidth; ++column) {
                const auto i = static_cast<std::size_t>(row * kWidth + column);
                const double z = depth_mm((column - kWidth / 2) / kFocal_px, (row - kHeight / 2) / kFocal_px);
                if (z < z_mm_[i]) {
                    z_mm_[i] = z;
                    leaf_at_[i] = number;
                }
            }
        count_ = std::max(count_, number);
    }
    /// The plane through `centre` with the axes `along` and `across`, where `inside` has it.
    void flat_leaf(int number, std::array<double, 3> centre, std::array<double, 3> along, std::array<double, 3> across,
                   const std::function<bool(double along_mm, double across_mm)>& inside)
    {
        const std::array<double, 3> n{along[1] * across[2] - along[2] * across[1],
                                      along[2] * across[0] - along[0] * across[2],
                                      along[0] * across[1] - along[1] * across[0]};
        leaf(number, [=](double x, double y) {
            const double facing = n[0] * x + n[1] * y + n[2];
            const double z = (n[0] * centre[0] + n[1] * centre[1] + n[2] * centre[2]) / facing;
            double s = 0, w = 0;
            const double at[3] = {x * z, y * z, z};
            for (std::size_t k = 0; k < 3; ++k) {
                s += (at[k] - centre[k]) * along[k];
                w += (at[k] - centre[k]) * across[k];
            }
            return inside(s, w) ? z : std::numeric_limits<double>::infinity();
        });
    }
    /// A wall seen in the corners: without it the cloud, and with it the picture, ends at the leaf.
    void wall()
    {
        leaf(0, [](double x, double y) {
            return std::fabs(x) > 0.19 && std::fabs(y) > 0.14 ? 1200 : std::numeric_limits<double>::infinity();
        });
    }
    /// Wrong by as much, evenly, one standard deviation of 0.58 times that.
    void shake(double most_mm)
    {
        std::mt19937 random(7);
        for (double& z : z_mm_)
            z += most_mm * (static_cast<double>(random()) / 2147483648.0 - 1);
    }

    Traits measured()
    {
        points_.clear();
        leaf_.clear();
        plant_.clear();
        for (int row = 0; row < kHeight; ++row)
            for (int column = 0; column < kWidth; ++column) {
                const auto i = static_cast<std::size_t>(row * kWidth + column);
                if (!std::isfinite(z_mm_[i]))
                    continue;
                const auto steps = [&](double at) {
                    return static_cast<std::int32_t>(std::lround(10 * at * z_mm_[i]));
                };
                points_.push_back({steps((column - kWidth / 2) / kFocal_px),
                                   steps((row - kHeight / 2) / kFocal_px),
                                   steps(1),
                                   {40, 120, 40},
                                   255});
                leaf_.push_back(static_cast<std::uint16_t>(leaf_at_[i]));
                plant_.push_back(leaf_at_[i] != 0);
            }
        plant_of_leaf_.assign(static_cast<std::size_t>(count_), 1);
        ground.kind = GroundFrame::Kind::kBench;
        Leaves leaves{leaf_, plant_, plant_of_leaf_, count_, 1, ground};
        table_ = std::make_unique<test::LentArena>(traits_bytes(points_.size(), count_, 1) + (std::size_t{4} << 20));
        const PlantView view = plant_view({points_, {}}, table_->arena()).value();
        return measure_traits(view, leaves, table_->arena()).value();
    }
    GroundFrame ground; ///< camera at the origin, up is up

private:
    std::vector<int> leaf_at_;
    std::vector<double> z_mm_;
    int count_ = 0;
    std::vector<CloudPoint> points_;
    std::vector<std::uint16_t> leaf_;
    std::vector<std::uint8_t> plant_, plant_of_leaf_;
    std::unique_ptr<test::LentArena> table_;
};

bool in_ellipse(double s, double w, double length, double width)
{
    return 4 * s * s / (length * length) + 4 * w * w / (width * width) <= 1;
}

/// 80 x 40 mm, 600 mm away, base left, its blade leaning back by `slant` from facing the camera.
void draw_ellipse(Drawn& scene, double slant, double turn = 0)
{
    const double c = std::cos(turn), s = std::sin(turn);
    const std::array<double, 3> right{1, 0, 0}, back{0, -std::cos(slant), std::sin(slant)};
    std::array<double, 3> along{}, across{};
    for (std::size_t k = 0; k < 3; ++k) {
        along[k] = c * right[k] + s * back[k];
        across[k] = c * back[k] - s * right[k];
    }
    scene.flat_leaf(1, {0, 0, 600}, along, across, [](double a, double b) { return in_ellipse(a, b, 80, 40); });
}

TEST(PlantTraits, a_flat_ellipse_has_its_axes_and_area_however_it_leans)
{
    for (const double slant_deg : {0.0, 30.0, 55.0})
        for (const double turn_deg : {0.0, 35.0, 90.0}) {
            Drawn scene;
            scene.wall();
            draw_ellipse(scene, slant_deg * kDegree, turn_deg * kDegree);
            const LeafTraits leaf = scene.measured().leaves[0];
            SCOPED_TRACE(testing::Message() << slant_deg << " deg, turned by " << turn_deg);
            EXPECT_NEAR(leaf.length_mm.value, 80, 2.4);
            EXPECT_NEAR(leaf.width_mm.value, 40, 1.6);
            EXPECT_NEAR(leaf.area_mm2.value, std::numbers::pi * 20 * 40, 0.03 * std::numbers::pi * 20 * 40);
            EXPECT_NEAR(leaf.inclination_deg.value, 90 - slant_deg, 1);
            EXPECT_FALSE(leaf.hidden || leaf.cut);
        }
}

TEST(PlantTraits, one_flat_leaf_is_not_taken_for_more_than_it_is_however_it_leans)
{
    for (const double slant_deg : {0.0, 15.0, 30.0, 45.0, 60.0, 70.0})
        for (const double turn_deg : {0.0, 35.0, 90.0}) {
            Drawn scene;
            scene.wall();
            draw_ellipse(scene, slant_deg * kDegree, turn_deg * kDegree);
            const Measured area = scene.measured().plants[0].leaf_area_visible_mm2;
            const double drawn_mm2 = std::numbers::pi * 20 * 40;
            SCOPED_TRACE(testing::Message() << slant_deg << " deg, turned by " << turn_deg);
            EXPECT_NEAR(area.value, drawn_mm2, 0.05 * drawn_mm2 + (slant_deg > 30 ? area.sd : 0));
            EXPECT_LT(area.sd, 0.3 * drawn_mm2);
        }
}

TEST(PlantTraits, noise_of_depth_does_not_lengthen_a_leaf)
{
    Drawn scene;
    draw_ellipse(scene, 30 * kDegree);
    scene.shake(1.5);
    const LeafTraits leaf = scene.measured().leaves[0];
    EXPECT_NEAR(leaf.length_mm.value, 80, 2.4);
    EXPECT_NEAR(leaf.width_mm.value, 40, 1.6);
    EXPECT_NEAR(leaf.area_mm2.value, std::numbers::pi * 20 * 40, 0.05 * std::numbers::pi * 20 * 40);
}

TEST(PlantTraits, a_leaf_on_a_cylinder_is_as_long_as_its_arc_and_as_curved)
{
    constexpr double kRadius_mm = 60, kHalfArc = 0.6; // 72 mm from base to tip
    Drawn scene;
    // The axis lies along y, 60 mm behind the nearest line; |y| <= 15 mm.
    scene.leaf(1, [](double x, double y) {
        const double centre = 600 + kRadius_mm, a = x * x + 1, b = centre;
        const double inside = b * b - a * (centre * centre - kRadius_mm * kRadius_mm);
        if (inside < 0)
            return std::numeric_limits<double>::infinity();
        const double z = (b - std::sqrt(inside)) / a;
        const bool on_leaf = std::fabs(x * z) <= kRadius_mm * std::sin(kHalfArc) && std::fabs(y * z) <= 15;
        return on_leaf ? z : std::numeric_limits<double>::infinity();
    });
    // Up is towards the camera: the leaf hangs down at both ends.
    const double up[3] = {0, 0, -1}, away[3] = {0, -1, 0};
    std::copy(up, up + 3, scene.ground.up);
    std::copy(away, away + 3, scene.ground.away);
    const LeafTraits leaf = scene.measured().leaves[0];
    EXPECT_NEAR(leaf.length_mm.value, 2 * kHalfArc * kRadius_mm, 1.5);
    EXPECT_NEAR(leaf.width_mm.value, 30, 1);
    EXPECT_NEAR(leaf.area_mm2.value, 2 * kHalfArc * kRadius_mm * 30, 0.03 * 2 * kHalfArc * kRadius_mm * 30);
    EXPECT_NEAR(leaf.curvature_per_m.value, 1000 / kRadius_mm, 0.15 * 1000 / kRadius_mm);
    EXPECT_NEAR(leaf.inclination_deg.value, 0, 1);
}

TEST(PlantTraits, a_petiole_is_no_length)
{
    Drawn scene;
    scene.flat_leaf(1, {0, 0, 600}, {1, 0, 0}, {0, 1, 0}, [](double s, double w) {
        return in_ellipse(s, w, 80, 40) || (s < 0 && s > -75 && std::fabs(w) < 1.5);
    });
    EXPECT_NEAR(scene.measured().leaves[0].length_mm.value, 80, 4);
}

TEST(PlantTraits, lobes_behind_the_petiole_are_no_length)
{
    Drawn scene;
    // An ellipse with a wedge cut out of its left end, 20 mm deep.
    scene.flat_leaf(1, {0, 0, 600}, {1, 0, 0}, {0, 1, 0}, [](double s, double w) {
        return in_ellipse(s, w, 90, 60) && !(s < -25 && std::fabs(w) < 0.8 * (-25 - s));
    });
    const LeafTraits leaf = scene.measured().leaves[0];
    EXPECT_NEAR(leaf.length_mm.value, 70, 3);
    EXPECT_LT(leaf.base_mm[0], leaf.tip_mm[0]);
}

TEST(PlantTraits, what_stands_in_front_and_the_edge_of_the_picture_are_told)
{
    Drawn hidden;
    hidden.wall();
    draw_ellipse(hidden, 0);
    hidden.flat_leaf(2, {25, 0, 500}, {1, 0, 0}, {0, 1, 0},
                     [](double s, double w) { return std::fabs(s) < 10 && std::fabs(w) < 30; });
    const Traits traits = hidden.measured();
    EXPECT_TRUE(traits.leaves[0].hidden);
    EXPECT_FALSE(traits.leaves[1].hidden);
    EXPECT_FALSE(traits.plants[0].cut);

    Drawn cut;
    cut.flat_leaf(1, {115, 0, 600}, {1, 0, 0}, {0, 1, 0}, [](double s, double w) { return in_ellipse(s, w, 80, 40); });
    cut.wall();
    EXPECT_TRUE(cut.measured().leaves[0].cut);
}

TEST(PlantTraits, a_plant_is_as_high_as_what_is_above_the_ground)
{
    // A sheet upright before the camera, from 100 mm below its axis to 60 above; the ground is 110 mm below.
    Drawn scene;
    scene.flat_leaf(1, {0, 20, 800}, {0, 1, 0}, {1, 0, 0},
                    [](double s, double w) { return std::fabs(s) <= 80 && std::fabs(w) <= 20; });
    scene.ground.origin_mm[1] = 110;
    scene.ground.height_sd_mm = 2;
    const PlantTraits plant = scene.measured().plants[0];
    EXPECT_NEAR(plant.height_max_mm.value, 170, 1.5);
    EXPECT_NEAR(plant.height_p99_mm.value, 170 - 1.6, 1.5);
    EXPECT_NEAR(plant.height_top10_mean_mm.value, 170 - 8, 1.5);
    EXPECT_GE(plant.height_p99_mm.sd, 2);
    EXPECT_EQ(plant.leaf_count.value, 1);
    EXPECT_NEAR(plant.greenness, 160.0 / 200, 1e-9); // (2 * 120 - 40 - 40) / (40 + 120 + 40)
}

TEST(PlantTraits, leaves_above_each_other_shade_the_ground_once)
{
    // Seen from above: the camera looks down, up is towards it.
    const double up[3] = {0, 0, -1}, away[3] = {0, -1, 0};
    Drawn scene;
    std::copy(up, up + 3, scene.ground.up);
    std::copy(away, away + 3, scene.ground.away);
    scene.flat_leaf(1, {0, 0, 600}, {1, 0, 0}, {0, 1, 0},
                    [](double s, double w) { return std::fabs(s) <= 40 && std::fabs(w) <= 20; });
    const PlantTraits plant = scene.measured().plants[0];
    EXPECT_NEAR(plant.projected_area_mm2.value, 80 * 40, 0.03 * 80 * 40);
    EXPECT_NEAR(plant.leaf_area_visible_mm2.value, 80 * 40, 0.03 * 80 * 40);
    EXPECT_NEAR(plant.inclination_mean_deg.value, 0, 1);
}

TEST(PlantTraits, memory_is_what_was_said_and_less_is_refused)
{
    Drawn scene;
    draw_ellipse(scene, 0);
    (void)scene.measured(); // within traits_bytes()
    std::vector<CloudPoint> points{{0, 0, 6000, {40, 120, 40}, 255}, {8, 0, 6000, {40, 120, 40}, 255}};
    std::vector<std::uint16_t> leaf{1, 1};
    std::vector<std::uint8_t> plant{1, 1}, plant_of_leaf{1};
    test::LentArena room(std::size_t{1} << 20);
    const PlantView view = plant_view({points, {}}, room.arena()).value();
    const Leaves leaves{leaf, plant, plant_of_leaf, 1, 1, {}};
    test::LentArena small(4096);
    const auto refused = measure_traits(view, leaves, small.arena());
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.status().fault(), Fault::kConfig);
    test::LentArena enough(traits_bytes(points.size(), 1, 1));
    const auto two_points = measure_traits(view, leaves, enough.arena());
    ASSERT_TRUE(two_points.ok());
    EXPECT_TRUE(std::isnan(two_points.value().leaves[0].length_mm.value));
}

std::int64_t hull_x6(std::vector<GridPoint> points)
{
    test::LentArena table(hull_bytes(points.size()));
    return hull_volume_x6(points, table.arena());
}

TEST(ConvexHull, a_cube_is_a_cube_whatever_lies_in_it_and_on_it)
{
    std::vector<GridPoint> points;
    for (int x = 0; x <= 10; x += 5)
        for (int y = 0; y <= 10; y += 5)
            for (int z = 0; z <= 10; z += 5)
                points.push_back({x, y, z});
    std::mt19937 random(1);
    for (int turn = 0; turn < 50; ++turn) {
        std::shuffle(points.begin(), points.end(), random);
        EXPECT_EQ(hull_x6(points), 6000);
    }
}

TEST(ConvexHull, points_in_a_plane_hold_nothing_and_the_largest_box_does_not_overflow)
{
    EXPECT_EQ(hull_x6({{0, 0, 0}, {5, 0, 0}, {0, 5, 0}, {5, 5, 0}, {2, 2, 0}}), 0);
    EXPECT_EQ(hull_x6({{3, 3, 3}, {3, 3, 3}, {3, 3, 3}, {3, 3, 3}}), 0);
    EXPECT_EQ(hull_x6({}), 0);
    std::vector<GridPoint> corners;
    for (const int x : {-kHullReach, kHullReach})
        for (const int y : {-kHullReach, kHullReach})
            for (const int z : {-kHullReach, kHullReach})
                corners.push_back({x, y, z});
    const std::int64_t side = 2 * std::int64_t{kHullReach};
    EXPECT_EQ(hull_x6(corners), 6 * side * side * side);
}

TEST(ConvexHull, a_ball_of_points_is_nearly_a_ball)
{
    std::mt19937 random(5);
    std::vector<GridPoint> points;
    while (points.size() < 4000) {
        const auto number = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
        const double x = number(), y = number(), z = number(), r = std::sqrt(x * x + y * y + z * z);
        if (r > 0.1 && r <= 1)
            points.push_back(
                {static_cast<int>(1000 * x / r), static_cast<int>(1000 * y / r), static_cast<int>(1000 * z / r)});
    }
    const double ball = 8 * std::numbers::pi * 1e9; // six times its volume
    EXPECT_NEAR(static_cast<double>(hull_x6(points)), ball, 0.01 * ball);
}

} // namespace
} // namespace dicot
