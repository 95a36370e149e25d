// Plants and leaves that are the same ones in the next snapshot.
#include "dicot/plant/tracking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace dicot {
namespace {

constexpr std::size_t kRoom = std::size_t{1} << 20;
alignas(Arena::kAlignment) std::array<std::byte, kRoom> block;

std::vector<std::int32_t> leaves_known(const std::vector<LeafMark>& known, const std::vector<LeafMark>& seen)
{
    Arena arena{block};
    std::vector<std::int32_t> known_of(seen.size(), 77);
    EXPECT_TRUE(match_leaves(known, seen, known_of, arena).ok());
    EXPECT_EQ(arena.used(), 0U);
    EXPECT_LE(arena.peak(), match_bytes(known.size(), seen.size()));
    return known_of;
}

std::vector<std::int32_t> plants_known(const std::vector<PlantStand>& known, const std::vector<PlantStand>& seen)
{
    Arena arena{block};
    std::vector<std::int32_t> known_of(seen.size(), 77);
    EXPECT_TRUE(match_plants(known, seen, known_of, arena).ok());
    return known_of;
}

/// Leaves around a stem, 40 mm apart on the mean, each 60 mm long.
std::vector<LeafMark> rosette(int count, unsigned seed)
{
    std::mt19937 dice(seed);
    std::uniform_real_distribution<double> place(-150, 150), turn(-1, 1);
    std::vector<LeafMark> leaves;
    while (static_cast<int>(leaves.size()) < count) {
        LeafMark leaf{{place(dice), place(dice), 600 + place(dice)}, {60 * turn(dice), 60 * turn(dice), 60}, 1500};
        const bool is_free = std::ranges::none_of(leaves, [&](const LeafMark& other) {
            return std::hypot(other.centre_mm[0] - leaf.centre_mm[0], other.centre_mm[1] - leaf.centre_mm[1],
                              other.centre_mm[2] - leaf.centre_mm[2]) < 20;
        });
        if (is_free)
            leaves.push_back(leaf);
    }
    return leaves;
}

TEST(LeafTracking, LeavesThatMoveAndGrowAreKnownAgainInAnyOrder)
{
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const std::vector<LeafMark> before = rosette(40, seed);
        std::mt19937 dice(seed);
        std::uniform_real_distribution<double> drift(-4, 4);
        std::vector<std::int32_t> order(before.size());
        std::iota(order.begin(), order.end(), 0);
        std::shuffle(order.begin(), order.end(), dice);
        std::vector<LeafMark> after;
        for (const std::int32_t k : order) {
            LeafMark leaf = before[static_cast<std::size_t>(k)];
            for (double& axis : leaf.centre_mm)
                axis += drift(dice);
            leaf.area_mm2 *= 1.15;
            after.push_back(leaf);
        }
        EXPECT_EQ(leaves_known(before, after), order) << "seed " << seed;
    }
}

TEST(LeafTracking, ANewLeafIsNobodyAndALostOneIsGivenToNobody)
{
    const std::vector<LeafMark> before{{{0, 0, 600}, {60, 0, 0}, 1500}, {{100, 0, 600}, {60, 0, 0}, 1500}};
    const std::vector<LeafMark> after{{{5, 0, 600}, {60, 0, 0}, 1500}, {{-80, 0, 600}, {60, 0, 0}, 1500}};
    EXPECT_EQ(leaves_known(before, after), (std::vector<std::int32_t>{0, kNobody}));
}

TEST(LeafTracking, WhichEndIsTheBaseDoesNotMatterButTheMidribDoes)
{
    const std::vector<LeafMark> before{{{0, 0, 600}, {60, 0, 0}, 1500}, {{12, 0, 600}, {0, 60, 0}, 1500}};
    // Both have moved to between the two places; only their midribs tell them apart.
    const std::vector<LeafMark> after{{{5, 0, 600}, {0, -60, 0}, 1500}, {{7, 0, 600}, {-60, 2, 0}, 1500}};
    EXPECT_EQ(leaves_known(before, after), (std::vector<std::int32_t>{1, 0}));
}

TEST(LeafTracking, ALeafDoesNotGrowFivefoldOvernight)
{
    const std::vector<LeafMark> before{{{0, 0, 600}, {60, 0, 0}, 300}};
    EXPECT_EQ(leaves_known(before, {{{0, 0, 600}, {60, 0, 0}, 1100}}), std::vector<std::int32_t>{0});
    EXPECT_EQ(leaves_known(before, {{{0, 0, 600}, {60, 0, 0}, 1500}}), std::vector<std::int32_t>{kNobody});
}

TEST(LeafTracking, NothingThatIsUnknownIsMatched)
{
    const double nan = std::nan("");
    const std::vector<LeafMark> flat{{{0, 0, 600}, {60, 0, 0}, nan}};
    EXPECT_EQ(leaves_known(flat, {{{0, 0, 600}, {60, 0, 0}, 300}}), std::vector<std::int32_t>{kNobody});
    EXPECT_TRUE(leaves_known(flat, {}).empty());
    EXPECT_EQ(leaves_known({}, flat), std::vector<std::int32_t>{kNobody});
}

TEST(LeafTracking, AnArenaThatIsTooSmallIsRefused)
{
    const std::vector<LeafMark> leaves = rosette(40, 1);
    std::vector<std::int32_t> known_of(leaves.size());
    Arena arena{std::span{block}.first(512)};
    EXPECT_EQ(match_leaves(leaves, leaves, known_of, arena).fault(), Fault::kSoftware);
}

TEST(PlantTracking, APlantThatGrowsUpwardsIsTheSameAndItsNeighbourIsNot)
{
    const double up[3] = {0, -0.8, -0.6}; // the cameras look down
    const auto stand = [&](double x, double z, double height) {
        return PlantStand{{x - 0.0, 100 + up[1] * height, z + up[2] * height}, {up[0], up[1], up[2]}, 40};
    };
    const std::vector<PlantStand> before{stand(-90, 700, 20), stand(90, 700, 20)};
    const std::vector<PlantStand> after{stand(300, 700, 20), stand(95, 705, 250), stand(-95, 700, 200)};
    EXPECT_EQ(plants_known(before, after), (std::vector<std::int32_t>{kNobody, 1, 0}));
}

TEST(PlantTracking, AStandIsTheMeanOfItsPlantsPoints)
{
    // Steps of 0.1 mm; plant 1 at x = -10 and 10 mm, one above the other; plant 2 one point; one of nobody.
    const std::vector<CloudPoint> points{
        {-100, 0, 6000, {}, 255}, {100, -400, 6000, {}, 255}, {1000, 0, 7000, {}, 255}, {9000, 0, 7000, {}, 255}};
    std::vector<std::uint8_t> plant{1, 1, 2, 0};
    PlantView view;
    view.cloud.points = points;
    Leaves leaves;
    leaves.plant = plant;
    leaves.plant_count = 2;
    std::array<PlantStand, 2> stands;
    plant_stands(view, leaves, stands);
    EXPECT_NEAR(stands[0].centre_mm[0], 0, 1e-9);
    EXPECT_NEAR(stands[0].centre_mm[1], -20, 1e-9);
    EXPECT_NEAR(stands[0].centre_mm[2], 600, 1e-9);
    EXPECT_NEAR(stands[0].spread_mm, 10, 1e-9) << "the 40 mm between them are upright";
    EXPECT_NEAR(stands[1].centre_mm[0], 100, 1e-9);
    EXPECT_NEAR(stands[1].spread_mm, 0, 1e-6);
}

} // namespace
} // namespace dicot
