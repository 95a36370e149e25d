// One rendered plant at eight stages of its growth, from pictures to curves: calibrated, matched and measured by the
// program itself, out of an archive with a slot missing.
#include "archive_folder.h"
#include "csv_numbers.h"
#include "own_rig.h"
#include "temp_folder.h"
#include "tool.h"

#include "dicot/picture/read_map.h"
#include "dicot/rectification/rectify.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace dicot {
namespace {

using nlohmann::json;

constexpr int kStages = 8;
constexpr int kDaysBetween = 5;
constexpr double kLeafPixels = 300; ///< as the leaves that are to be found

const std::string kRigDev = std::string{DICOT_DATA_DIR} + "/rig-dev/";
const std::string kGrowth = kRigDev + "growth/";

bool data_there(const char* test)
{
    if (std::filesystem::exists(kGrowth + "gt_growth.csv"))
        return true;
    std::printf("NOT RUN: %s: %s is not there\n", test, kGrowth.c_str());
    return false;
}

test::ToolRun dicot(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " " + words);
}

std::string day_of(int stage)
{
    const int day = 1 + (stage - 1) * kDaysBetween;
    char text[32];
    std::snprintf(text, sizeof text, "2026-%02d-%02dT10:00:00Z", day > 31 ? 6 : 5, day > 31 ? day - 31 : day);
    return text;
}

/// The clouds of all stages: of `DICOT_CLOUDS`, where somebody made them before, or made now.
std::string cloud_of(int stage, const test::TempFolder& folder)
{
    const std::string name = "growth_stage" + std::to_string(stage) + ".drc";
    if (const char* const made = std::getenv("DICOT_CLOUDS"))
        return std::string{made} + "/" + name;
    const std::string rig = folder.path("rig.yaml");
    if (!std::filesystem::exists(rig)) {
        const std::string boards = kRigDev + "calibration/";
        const test::ToolRun made =
            dicot("calibrate --images " + boards + "board10x10_41mm --squares 10x10 --square-mm 41 --images " + boards +
                  "board8x8_46mm --squares 8x8 --square-mm 46 -o " + rig);
        EXPECT_EQ(made.exit_code, 0) << made.output;
    }
    const std::string pictures = kGrowth + "stage" + std::to_string(stage);
    const test::ToolRun made = dicot("process " + pictures + "_left.jpg " + pictures + "_right.jpg --rig " + rig +
                                     " --method best --near-mm 400 --far-mm 1400 -o " + folder.path(name));
    EXPECT_EQ(made.exit_code, 0) << made.output;
    return folder.path(name);
}

/// Everything that is judged, made once.
struct Grown
{
    json board;                                        ///< of dicot traits --json
    std::vector<std::map<std::string, double>> leaves; ///< of the table beside --csv
    std::vector<int> sequence;                         ///< of each stage
};

const Grown& grown()
{
    static const Grown made = [] {
        Grown all;
        const test::TempFolder folder;
        test::ArchiveFolder archive(folder.path("archive"), "bench", "Europe/Berlin");
        int number = 0;
        for (int stage = 1; stage <= kStages; ++stage) {
            archive.done(++number, day_of(stage), cloud_of(stage, folder));
            all.sequence.push_back(number);
            if (stage == kStages / 2)
                archive.missed(++number, "2026-05-18T10:00:00Z", "the left camera is gone");
        }
        std::filesystem::create_directories(DICOT_PICTURES_DIR);
        const test::ToolRun run =
            dicot("traits " + folder.path("archive") + " --cache " + folder.path("cache") + " --json --csv " +
                  folder.path("growth.csv") + " --plot " + std::string{DICOT_PICTURES_DIR} + "/growth");
        EXPECT_EQ(run.exit_code, 0) << run.output;
        all.board = json::parse(run.output).at("boards").at(0);
        all.leaves = test::csv_numbers(folder.path("growth.leaves.csv"));
        return all;
    }();
    return made;
}

/// The plant that was seen most often.
const json& main_plant()
{
    const json* best = nullptr;
    for (const json& plant : grown().board.at("plants"))
        if (best == nullptr || plant.at("snapshots") > best->at("snapshots"))
            best = &plant;
    return *best;
}

struct Series
{
    std::vector<double> measured, curve;
};

Series series_of(const std::string& trait)
{
    Series series;
    for (const json& one : main_plant().at("series")) {
        if (one.at("trait") != trait)
            continue;
        for (const json& sample : one.at("samples")) {
            series.measured.push_back(sample.at("value").at(0));
            series.curve.push_back(sample.at("expected").at(0));
        }
    }
    return series;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b)
{
    const double n = static_cast<double>(a.size());
    double sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sa += a[i];
        sb += b[i];
        aa += a[i] * a[i];
        bb += b[i] * b[i];
        ab += a[i] * b[i];
    }
    return (ab - sa * sb / n) / std::sqrt((aa - sa * sa / n) * (bb - sb * sb / n));
}

std::vector<double> truth_of(const char* column)
{
    std::vector<double> values;
    for (const auto& row : test::csv_numbers(kGrowth + "gt_growth.csv"))
        values.push_back(row.at(column));
    return values;
}

std::vector<float> map_of(const std::string& path, double scale, PictureSize& size)
{
    size = map_head(path.c_str()).value().size;
    std::vector<float> values(static_cast<std::size_t>(size.pixels()));
    EXPECT_TRUE(read_map(path.c_str(), scale, {values.data(), size.width, size.height}).ok());
    return values;
}

/// Of the true surface under the pixels that show a leaf: each pixel's share of the plane through its neighbours on the
/// same leaf.
double true_visible_area_mm2(int stage)
{
    PictureSize size;
    const std::string name = kGrowth + "gt_stage" + std::to_string(stage);
    const std::vector<float> depth = map_of(name + "_depth.png", 10, size);
    const std::vector<float> leaf = map_of(name + "_leaf_id.png", 1, size);
    const Lens& lens = test::own_rig().left;
    const auto at = [&](int x, int y) {
        const Point2 direction = undistort(lens, {static_cast<double>(x), static_cast<double>(y)}).value();
        const double z = static_cast<double>(depth[static_cast<std::size_t>(y * size.width + x)]);
        return Point3{direction.x * z, direction.y * z, z};
    };
    double sum = 0;
    for (int y = 1; y + 1 < size.height; ++y)
        for (int x = 1; x + 1 < size.width; ++x) {
            const auto id = [&](int dx, int dy) {
                return leaf[static_cast<std::size_t>((y + dy) * size.width + x + dx)];
            };
            if (!std::isfinite(id(0, 0)))
                continue;
            const bool left = id(-1, 0) == id(0, 0), right = id(1, 0) == id(0, 0);
            const bool above = id(0, -1) == id(0, 0), below = id(0, 1) == id(0, 0);
            if ((!left && !right) || (!above && !below))
                continue;
            const Point3 a = at(left ? x - 1 : x, y), b = at(right ? x + 1 : x, y);
            const Point3 c = at(x, above ? y - 1 : y), d = at(x, below ? y + 1 : y);
            const double across = left && right ? 2 : 1, along = above && below ? 2 : 1;
            const Point3 u{(b.x - a.x) / across, (b.y - a.y) / across, (b.z - a.z) / across};
            const Point3 v{(d.x - c.x) / along, (d.y - c.y) / along, (d.z - c.z) / along};
            sum += std::hypot(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
        }
    return sum;
}

TEST(Growth, TheCurveOfLeafAreaFollowsTheTruth)
{
    if (!data_there("Growth.TheCurveOfLeafAreaFollowsTheTruth"))
        return;
    const Series area = series_of("leaf_area_visible_mm2");
    ASSERT_EQ(area.measured.size(), static_cast<std::size_t>(kStages)) << "it is one plant all the time";
    const std::vector<double> whole = truth_of("total_leaf_area_mm2");
    std::vector<double> visible;
    std::printf("  stage | measured | curve   | visible | whole (true), mm2\n");
    for (int stage = 1; stage <= kStages; ++stage) {
        const auto i = static_cast<std::size_t>(stage - 1);
        visible.push_back(true_visible_area_mm2(stage));
        std::printf("  %5d | %8.0f | %7.0f | %7.0f | %7.0f\n", stage, area.measured[i], area.curve[i], visible[i],
                    whole[i]);
    }
    const double with_whole = correlation(area.curve, whole), with_visible = correlation(area.curve, visible);
    std::printf("  correlation with the whole area: curve %.4f, measured %.4f; with the visible: %.4f, %.4f\n",
                with_whole, correlation(area.measured, whole), with_visible, correlation(area.measured, visible));
    EXPECT_GE(with_whole, 0.98);
    EXPECT_GE(with_visible, 0.98);
}

TEST(Growth, TheCurveOfHeightFollowsTheTruth)
{
    if (!data_there("Growth.TheCurveOfHeightFollowsTheTruth"))
        return;
    const Series height = series_of("height_p99_mm");
    const std::vector<double> truth = truth_of("height_above_soil_mm");
    ASSERT_EQ(height.curve.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i)
        std::printf("  stage %zu: curve %.0f mm, true %.0f mm\n", i + 1, height.curve[i], truth[i]);
    const double r = correlation(height.curve, truth);
    std::printf("  correlation %.4f\n", r);
    EXPECT_GE(r, 0.99);
}

TEST(Growth, TheMissedSlotIsAGapWithItsReason)
{
    if (!data_there("Growth.TheMissedSlotIsAGapWithItsReason"))
        return;
    ASSERT_EQ(grown().board.at("gaps").size(), 1u);
    const json& gap = grown().board["gaps"][0];
    EXPECT_EQ(gap["from"], day_of(4));
    EXPECT_EQ(gap["to"], day_of(5));
    EXPECT_EQ(gap["reason"], "the left camera is gone");
}

/// Leaves bear a number through all stages in the truth too. A measured leaf stands for the true one whose centre is
/// nearest, if it is within 15 mm and no other measured one is nearer to it.
TEST(Growth, LeavesKeepTheirNumbers)
{
    if (!data_there("Growth.LeavesKeepTheirNumbers"))
        return;
    const Turn rectifying = rectify(test::own_rig(), kCrop, "rig").value().left_rectifying;
    std::vector<std::map<int, int>> track_of(kStages); // of a true leaf
    for (int stage = 1; stage <= kStages; ++stage) {
        const auto i = static_cast<std::size_t>(stage - 1);
        std::map<int, double> nearest;
        for (const auto& truth : test::csv_numbers(kGrowth + "gt_stage" + std::to_string(stage) + "_leaves.csv")) {
            if (truth.at("visible_px") < kLeafPixels)
                continue;
            const Point3 centre =
                turned(rectifying, {truth.at("centre_x_mm"), truth.at("centre_y_mm"), truth.at("centre_z_mm")});
            const auto id = static_cast<int>(truth.at("leaf_id"));
            for (const auto& leaf : grown().leaves) {
                if (leaf.at("sequence") != grown().sequence[i] || leaf.at("plant") != main_plant().at("plant"))
                    continue;
                const double apart = std::hypot(leaf.at("centre_x_mm") - centre.x, leaf.at("centre_y_mm") - centre.y,
                                                leaf.at("centre_z_mm") - centre.z);
                if (apart < 15 && (!nearest.contains(id) || apart < nearest[id])) {
                    nearest[id] = apart;
                    track_of[i][id] = static_cast<int>(leaf.at("leaf"));
                }
            }
        }
    }
    int pairs = 0, kept = 0;
    for (std::size_t i = 1; i < kStages; ++i)
        for (const auto& [id, track] : track_of[i])
            if (track_of[i - 1].contains(id)) {
                ++pairs;
                kept += track_of[i - 1][id] == track ? 1 : 0;
            }
    std::printf("  leaves of %d px and more that were found in two stages running: %d, the same number: %d (%.0f %%)\n",
                static_cast<int>(kLeafPixels), pairs, kept, 100.0 * kept / pairs);
    ASSERT_GE(pairs, 20);
    EXPECT_GE(kept, 0.8 * pairs);
}

} // namespace
} // namespace dicot
