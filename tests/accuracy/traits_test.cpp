// Lengths, widths, areas and heights of the rendered plants: with true leaves, and with those that are found.
#include "calibration_data.h"
#include "leaf_scene.h"
#include "lent_arena.h"

#include "dicot/plant/leaves.h"
#include "dicot/plant/traits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace dicot::test {
namespace {

/// Errors of whole leaves, relative, and in standard deviations; of plants.
struct Errors
{
    std::vector<double> length, width, area;
    std::vector<double> length_sds, width_sds, area_sds, slant_sds;
    std::vector<double> slant_deg, plant_area, plant_area_sds, height_mm;
    int whole = 0, flagged = 0;
    int turned_round = 0;
};

double median_size(std::vector<double> values)
{
    for (double& value : values)
        value = std::fabs(value);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return values.empty() ? NAN : *middle;
}

double median(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return values.empty() ? NAN : *middle;
}

double share_within_one(const std::vector<double>& sds)
{
    const auto within = std::ranges::count_if(sds, [](double value) { return std::fabs(value) <= 1; });
    return static_cast<double>(within) / static_cast<double>(std::max<std::size_t>(1, sds.size()));
}

double apart(const double (&a)[3], const Point3& b)
{
    return std::hypot(a[0] - b.x, a[1] - b.y, a[2] - b.z);
}

void compare(const LeafTraits& ours, const TrueLeaf& leaf, Errors& errors)
{
    const auto add = [](const Measured& measured, double truth, std::vector<double>& relative,
                        std::vector<double>& sds) {
        if (std::isnan(measured.value))
            return;
        relative.push_back(measured.value / truth - 1);
        sds.push_back((measured.value - truth) / measured.sd);
    };
    add(ours.length_mm, leaf.length_mm, errors.length, errors.length_sds);
    add(ours.width_mm, leaf.width_mm, errors.width, errors.width_sds);
    add(ours.area_mm2, leaf.area_mm2, errors.area, errors.area_sds);
    errors.slant_deg.push_back(ours.inclination_deg.value - leaf.slant_deg);
    errors.slant_sds.push_back(errors.slant_deg.back() / ours.inclination_deg.sd);
    errors.turned_round += apart(ours.base_mm, leaf.base) > apart(ours.base_mm, leaf.tip);
    errors.flagged += ours.hidden || ours.cut;
    ++errors.whole;
}

void compare(const PlantTraits& ours, const GroundFrame& ground, const LeafScene& scene, Errors& errors)
{
    // Where leaves hide the soil, heights are above what the pot stands on.
    const double truth_mm = ground.kind == GroundFrame::Kind::kBench ? scene.above_bench_mm : scene.above_soil_mm;
    const Measured& area = ours.leaf_area_visible_mm2;
    errors.plant_area.push_back(area.value / scene.visible_mm2 - 1);
    errors.plant_area_sds.push_back((area.value - scene.visible_mm2) / area.sd);
    errors.height_mm.push_back(ours.height_max_mm.value - truth_mm);
}

void print(const char* name, const Errors& e)
{
    std::printf("| %-22s | %3d | %5.1f %+5.1f | %5.1f %+5.1f | %5.1f %+5.1f | %4.1f | %+6.1f | %+6.1f |\n", name,
                e.whole, 100 * median_size(e.length), 100 * median(e.length), 100 * median_size(e.width),
                100 * median(e.width), 100 * median_size(e.area), 100 * median(e.area), median_size(e.slant_deg),
                100 * median(e.plant_area), median(e.height_mm));
}

void print_head(const char* whose)
{
    std::printf("%s: medians of |error| and of error\n"
                "| %-22s | %3s | %11s | %11s | %11s | %4s | %6s | %6s |\n"
                "| %-22s | %3s | %11s | %11s | %11s | %4s | %6s | %6s |\n",
                whose, "whole leaves", "n", "length %", "width %", "area %", "incl", "plant", "height", "", "", "", "",
                "", "deg", "area %", "mm");
}

void print_sum(const Errors& e)
{
    std::printf("within one sd, %%: length %.0f, width %.0f, area %.0f, inclination %.0f; plants' area %.0f\n"
                "taken for hidden or cut: %d of %d; base and tip mistaken for each other: %d\n"
                "plants: median |error| of visible area %.1f %%, of height %.1f mm, worst %.1f mm\n",
                100 * share_within_one(e.length_sds), 100 * share_within_one(e.width_sds),
                100 * share_within_one(e.area_sds), 100 * share_within_one(e.slant_sds),
                100 * share_within_one(e.plant_area_sds), e.flagged, e.whole, e.turned_round,
                100 * median_size(e.plant_area), median_size(e.height_mm),
                std::fabs(*std::ranges::max_element(e.height_mm, {}, [](double mm) { return std::fabs(mm); })));
    std::fflush(stdout);
}

void append(Errors& to, const Errors& from)
{
    const auto join = [](std::vector<double>& a, const std::vector<double>& b) {
        a.insert(a.end(), b.begin(), b.end());
    };
    for (std::vector<double> Errors::*list :
         {&Errors::length, &Errors::width, &Errors::area, &Errors::length_sds, &Errors::width_sds, &Errors::area_sds,
          &Errors::slant_sds, &Errors::slant_deg, &Errors::plant_area, &Errors::plant_area_sds, &Errors::height_mm})
        join(to.*list, from.*list);
    to.whole += from.whole;
    to.flagged += from.flagged;
    to.turned_round += from.turned_round;
}

/// The true leaves' points, without those that are not on them: what a segmentation could at best give.
struct TrueLeaves
{
    std::vector<std::uint16_t> leaf;
    std::vector<std::uint8_t> plant, plant_of_leaf;
    Leaves leaves;

    explicit TrueLeaves(const LeafScene& scene)
    {
        constexpr float kOff_mm = 15;
        int most = 0;
        for (const TrueLeaf& one : scene.leaves)
            most = std::max(most, one.id);
        for (std::size_t i = 0; i < scene.points.size(); ++i) {
            const bool on_it = std::fabs(scene.off_mm[i]) < kOff_mm;
            leaf.push_back(static_cast<std::uint16_t>(on_it ? scene.leaf[i] : 0));
            plant.push_back(leaf.back() != 0);
        }
        plant_of_leaf.assign(static_cast<std::size_t>(most), 1);
        leaves = {leaf, plant, plant_of_leaf, most, 1, scene.ground};
    }
};

/// The true leaf that most of a found one's points are of, where both overlap by more than half of their union.
const TrueLeaf* matching(const LeafScene& scene, const Leaves& leaves, int found)
{
    std::vector<long> common(2000, 0);
    long ours = 0;
    for (std::size_t i = 0; i < scene.points.size(); ++i)
        if (leaves.leaf[i] == found) {
            ++ours;
            ++common[static_cast<std::size_t>(scene.leaf[i])];
        }
    const auto best = std::max_element(common.begin() + 1, common.end());
    const int id = static_cast<int>(best - common.begin());
    const long theirs = std::ranges::count(scene.leaf, id);
    const auto leaf = std::ranges::find(scene.leaves, id, &TrueLeaf::id);
    return leaf != scene.leaves.end() && *best * 2 > ours + theirs - *best ? &*leaf : nullptr;
}

/// Medians of |error|, relative.
struct Bounds
{
    double length, width, area, plant_area;
};

void expect_within(const Bounds& bounds, const Errors& e)
{
    EXPECT_LE(median_size(e.length), bounds.length);
    EXPECT_LE(median_size(e.width), bounds.width);
    EXPECT_LE(median_size(e.area), bounds.area);
    EXPECT_LE(median_size(e.plant_area), bounds.plant_area);
    EXPECT_LE(median_size(e.height_mm), 10);
}

TEST(TraitsAccuracy, plants_and_whole_leaves_of_true_outline_are_as_measured)
{
    if (!data_there("rig-dev/plants"))
        return;
    Errors all;
    print_head("true leaves");
    for (const LeafScene& scene : plant_scenes()) {
        const TrueLeaves truth(scene);
        LentArena table(traits_bytes(scene.points.size(), truth.leaves.leaf_count, 1) + (std::size_t{32} << 20));
        const PlantView view = plant_view(scene.cloud(), table.arena()).value();
        const Traits traits = measure_traits(view, truth.leaves, table.arena()).value();
        Errors errors;
        for (const TrueLeaf& leaf : scene.leaves)
            if (leaf.whole())
                compare(traits.leaves[static_cast<std::size_t>(leaf.id - 1)], leaf, errors);
        compare(traits.plants[0], scene.ground, scene, errors);
        print(scene.name.c_str(), errors);
        append(all, errors);
    }
    print("all", all);
    print_sum(all);
    expect_within({.length = 0.07, .width = 0.06, .area = 0.12, .plant_area = 0.10}, all);
}

TEST(TraitsAccuracy, plants_and_whole_leaves_that_are_found_are_as_measured)
{
    if (!data_there("rig-dev/plants"))
        return;
    Errors all;
    print_head("leaves as found");
    for (const LeafScene& scene : plant_scenes()) {
        LentArena room(std::size_t{32} << 20);
        const PlantView view = plant_view(scene.cloud(), room.arena()).value();
        LentArena table(segment_leaves_bytes(view) + traits_bytes(scene.points.size(), UINT16_MAX, UINT8_MAX));
        const Leaves leaves = segment_leaves(view, {}, table.arena()).value();
        const Traits traits = measure_traits(view, leaves, table.arena()).value();
        Errors errors;
        for (const LeafTraits& found : traits.leaves) {
            const TrueLeaf* leaf = matching(scene, leaves, found.leaf);
            if (leaf && leaf->whole())
                compare(found, *leaf, errors);
        }
        // Others may stand beside it: the plant is the largest.
        if (const auto plant = std::ranges::max_element(traits.plants, {}, &PlantTraits::points);
            plant != traits.plants.end())
            compare(*plant, leaves.ground, scene, errors);
        print(scene.name.c_str(), errors);
        append(all, errors);
    }
    print("all", all);
    print_sum(all);
    expect_within({.length = 0.10, .width = 0.10, .area = 0.15, .plant_area = 0.10}, all);
}

} // namespace
} // namespace dicot::test
