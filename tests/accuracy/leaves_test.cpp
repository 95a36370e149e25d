// How many leaves of the rendered plants are found, by the points of their clouds.
//
// A found leaf and a true one overlap by the points that both have, divided by those that one of them has; a point's
// true leaf is that of the pixel it was seen at. A true leaf is found where one overlaps by a half at least. Said
// thrice: for leaves that the left picture shows by more than 300 pixels; for those of which both cameras see more than
// 300, since a leaf that one camera sees has no points; and with the pixels that have no point counted against the
// overlap.
//
// A found leaf is surplus where most of its points are of a true leaf that another found one has more of; it is none
// where most of them are of no leaf (fruit, stem). A true leaf is split where two found ones hold a seventh of its
// points each, or more, and are mostly its own.
#include "calibration_data.h"
#include "leaf_scene.h"
#include "lent_arena.h"

#include "dicot/plant/leaves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace dicot::test {
namespace {

constexpr long kVisiblePx = 300;

struct Counts
{
    int leaves = 0, found = 0;          ///< by the left picture's pixels
    int by_both = 0, by_both_found = 0; ///< by those of both cameras
    int found_of_pixels = 0;            ///< overlap by pixels
    int coverable = 0;                  ///< half of their pixels have points: as many could be found by pixels
    int segments = 0, surplus = 0, none = 0, split = 0;

    Counts& operator+=(const Counts& other)
    {
        leaves += other.leaves;
        found += other.found;
        by_both += other.by_both;
        by_both_found += other.by_both_found;
        found_of_pixels += other.found_of_pixels;
        coverable += other.coverable;
        segments += other.segments;
        surplus += other.surplus;
        none += other.none;
        split += other.split;
        return *this;
    }
};

double share(int part, int whole)
{
    return 100.0 * part / whole;
}

Counts count(const LeafScene& scene, const Leaves& leaves)
{
    const auto found = static_cast<std::size_t>(leaves.leaf_count) + 1;
    int most = 0;
    for (const TrueLeaf& leaf : scene.leaves)
        most = std::max(most, leaf.id);
    const auto true_count = static_cast<std::size_t>(most) + 1;
    std::vector<long> both(true_count * found), of_true(true_count), of_found(found);
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        const auto is = static_cast<std::size_t>(scene.leaf[i]);
        ++both[is * found + leaves.leaf[i]];
        ++of_true[is];
        ++of_found[leaves.leaf[i]];
    }
    const auto mostly = [&](std::size_t segment) {
        std::size_t best = 0;
        for (std::size_t leaf = 0; leaf < true_count; ++leaf)
            if (both[leaf * found + segment] > both[best * found + segment])
                best = leaf;
        return best;
    };

    Counts counts;
    for (const TrueLeaf& leaf : scene.leaves) {
        if (leaf.pixels <= kVisiblePx)
            continue;
        const auto id = static_cast<std::size_t>(leaf.id);
        double by_points = 0, by_pixels = 0;
        int parts = 0;
        for (std::size_t segment = 1; segment < found; ++segment) {
            const auto common = static_cast<double>(both[id * found + segment]);
            by_points = std::max(
                by_points, common / static_cast<double>(of_true[id] + of_found[segment] - both[id * found + segment]));
            by_pixels = std::max(
                by_pixels, common / static_cast<double>(leaf.pixels + of_found[segment] - both[id * found + segment]));
            parts += 7 * both[id * found + segment] >= of_true[id] && common > 0 && mostly(segment) == id;
        }
        ++counts.leaves;
        counts.found += by_points >= 0.5;
        counts.found_of_pixels += by_pixels >= 0.5;
        counts.coverable += 2 * of_true[id] >= leaf.pixels;
        counts.split += parts > 1;
        if (leaf.by_both > kVisiblePx) {
            ++counts.by_both;
            counts.by_both_found += by_points >= 0.5;
        }
    }
    for (std::size_t segment = 1; segment < found; ++segment) {
        const std::size_t leaf = mostly(segment);
        ++counts.segments;
        if (leaf == 0) {
            ++counts.none;
            continue;
        }
        const auto row = both.begin() + static_cast<std::ptrdiff_t>(leaf * found);
        counts.surplus += std::max_element(row + 1, row + static_cast<std::ptrdiff_t>(found)) - row !=
                          static_cast<std::ptrdiff_t>(segment);
    }
    return counts;
}

void print(const char* name, const Counts& c)
{
    std::printf("| %-22s | %3d of %3d | %3d of %3d | %3d (%3d) | %8d | %7d | %4d | %5d |\n", name, c.by_both_found,
                c.by_both, c.found, c.leaves, c.found_of_pixels, c.coverable, c.segments, c.surplus, c.none, c.split);
}

struct Seen
{
    Counts counts;
    double worst_up_deg = 0, worst_soil_mm = 0, seconds = 0;
    int soils = 0;
};

const Seen& all_plants()
{
    static const Seen seen = [] {
        Seen all;
        std::printf("| %-22s | %-10s | %-10s | %-9s | %-8s | %-7s | %-4s | %-5s |\n", "leaves", "by both", "by left",
                    "of pixels", "segments", "surplus", "none", "split");
        for (const LeafScene& scene : plant_scenes()) {
            LentArena room(std::size_t{128} << 20);
            Arena& arena = room.arena();
            const PlantView view = plant_view(scene.cloud(), arena).value();
            const std::size_t before = arena.used();
            const std::clock_t start = std::clock();
            const Leaves leaves = segment_leaves(view, {}, arena).value();
            all.seconds = std::max(all.seconds, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
            EXPECT_LE(arena.peak() - before, segment_leaves_bytes(view)) << scene.name;
            EXPECT_EQ(leaves.plant_count, 1) << scene.name;

            const Counts counts = count(scene, leaves);
            print(scene.name.c_str(), counts);
            all.counts += counts;

            double along = 0, from_soil = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                along += leaves.ground.up[axis] * scene.ground.up[axis];
                from_soil += (leaves.ground.origin_mm[axis] - scene.ground.origin_mm[axis]) * scene.ground.up[axis];
            }
            // Sines are exact where the cosine of a small angle is not.
            const double across = std::sqrt(std::max(0.0, 1 - along * along));
            all.worst_up_deg = std::max(all.worst_up_deg, std::asin(std::min(1.0, across)) * 180 / 3.14159265358979);
            if (leaves.ground.kind == GroundFrame::Kind::kSoil) {
                ++all.soils;
                // The foot of a perpendicular moves along with the direction: heights are compared under the camera.
                all.worst_soil_mm = std::max(all.worst_soil_mm, std::fabs(from_soil));
            }
        }
        print("all", all.counts);
        return all;
    }();
    return seen;
}

TEST(LeavesOfRenderedPlants, AreFound)
{
    if (!data_there("rig-dev"))
        return;
    const Counts& c = all_plants().counts;
    std::printf("found: %.1f %% of the leaves that both cameras see by more than 300 px, %.1f %% of those that the "
                "left one does; "
                "by pixels %.1f %%, where %.1f %% could be\n"
                "surplus: %.1f %% of the visible leaves; split: %.1f %%; at most %.2f s\n",
                share(c.by_both_found, c.by_both), share(c.found, c.leaves), share(c.found_of_pixels, c.leaves),
                share(c.coverable, c.leaves), share(c.surplus, c.leaves), share(c.split, c.leaves),
                all_plants().seconds);
    EXPECT_GE(share(c.by_both_found, c.by_both), 86);
    EXPECT_GE(share(c.found, c.leaves), 77);
    EXPECT_LE(share(c.surplus, c.leaves), 18);
    EXPECT_LE(share(c.none, c.leaves), 10);
    EXPECT_LE(share(c.split, c.leaves), 12);
}

TEST(GroundOfRenderedPlants, IsLevel)
{
    if (!data_there("rig-dev"))
        return;
    std::printf("up: within %.2f degrees; soil found %d times, within %.1f mm\n", all_plants().worst_up_deg,
                all_plants().soils, all_plants().worst_soil_mm);
    EXPECT_LE(all_plants().worst_up_deg, 1);
    EXPECT_LE(all_plants().worst_soil_mm, 10);
}

} // namespace
} // namespace dicot::test
