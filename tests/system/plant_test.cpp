// dicot plant: four discs over soil, measured from a file, from a stored slot, into tables, JSON and coloured clouds.
#include "archive_folder.h"
#include "csv_lines.h"
#include "drawn_plant.h"
#include "temp_folder.h"
#include "tool.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace dicot {
namespace {

using nlohmann::json;
using test::ToolRun;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kRadius_mm = 14, kArea_mm2 = 3.14159 * kRadius_mm * kRadius_mm;

using Row = std::map<std::string, std::string>;

std::vector<Row> table(const std::string& path)
{
    std::ifstream file(path);
    std::string heading;
    std::getline(file, heading);
    std::vector<std::string> names;
    std::istringstream cells(heading);
    for (std::string name; std::getline(cells, name, ',');)
        names.push_back(name);
    std::vector<Row> rows;
    for (const auto& line : test::csv_lines(path)) {
        EXPECT_EQ(line.size(), names.size()) << path;
        Row& row = rows.emplace_back();
        for (std::size_t i = 0; i < std::min(names.size(), line.size()); ++i)
            row[names[i]] = line[i];
    }
    return rows;
}

class Plant : public testing::Test
{
protected:
    Plant() { test::write_plant(cloud_, {.leaves = 4, .radius_mm = kRadius_mm}); }

    static ToolRun plant(const std::string& words) { return test::run(std::string{DICOT_PROGRAM} + " plant " + words); }
    json report(const std::string& words) const
    {
        const ToolRun told = plant(words + " --json");
        EXPECT_EQ(told.exit_code, 0) << told.output;
        return json::parse(told.output, nullptr, false);
    }
    std::string written(const std::string& name, const std::string& text) const
    {
        std::ofstream(folder_.path(name)) << text;
        return folder_.path(name);
    }

    test::TempFolder folder_;
    std::string cloud_ = folder_.path("cloud.drc");
};

TEST_F(Plant, has_a_line_and_each_leaf_has_one)
{
    const ToolRun run = plant(cloud_ + " --csv " + folder_.path("t.csv"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("1 plant"), HasSubstr("plant 1"), HasSubstr("visible leaf area")));
    const auto plants = table(folder_.path("t.csv"));
    ASSERT_EQ(plants.size(), 1U);
    EXPECT_NEAR(std::stod(plants[0].at("leaf_count")), 4, 0.1);
    EXPECT_NEAR(std::stod(plants[0].at("leaf_area_visible_mm2")), 4 * kArea_mm2, 0.1 * 4 * kArea_mm2);
    EXPECT_EQ(plants[0].at("cloud"), cloud_);
    const auto leaves = table(folder_.path("t.leaves.csv"));
    ASSERT_EQ(leaves.size(), 4U);
    for (const Row& leaf : leaves) {
        EXPECT_NEAR(std::stod(leaf.at("leaf_length_mm")), 2 * kRadius_mm, 0.1 * 2 * kRadius_mm);
        EXPECT_NEAR(std::stod(leaf.at("leaf_width_mm")), 2 * kRadius_mm, 0.1 * 2 * kRadius_mm);
        EXPECT_NEAR(std::stod(leaf.at("leaf_area_mm2")), kArea_mm2, 0.1 * kArea_mm2);
        EXPECT_GT(std::stod(leaf.at("leaf_area_mm2_sd")), 0);
        EXPECT_EQ(leaf.at("hidden"), "0");
        EXPECT_EQ(leaf.at("plant"), "1");
    }
    const std::array names{"centre_x_mm", "centre_y_mm", "centre_z_mm"};
    std::array<double, 3> middle_mm{};
    for (const Row& leaf : leaves)
        for (std::size_t axis = 0; axis < 3; ++axis)
            middle_mm[axis] += std::stod(leaf.at(names[axis])) / 4;
    for (const Row& leaf : leaves) { // they stand on a ring
        double squares = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            squares += std::pow(std::stod(leaf.at(names[axis])) - middle_mm[axis], 2);
        EXPECT_NEAR(std::sqrt(squares), test::DrawnPlant{}.ring_mm, 2);
    }
}

TEST_F(Plant, as_json_is_laid_out_as_plantcv_keeps_results)
{
    const json report = this->report(cloud_);
    const json& area = report["observations"]["plant_1"]["leaf_area_visible_mm2"];
    EXPECT_NEAR(area["value"].get<double>(), 4 * kArea_mm2, 0.1 * 4 * kArea_mm2);
    for (const char* key : {"trait", "method", "scale", "datatype", "label", "sd"})
        EXPECT_TRUE(area.contains(key)) << key;
    EXPECT_EQ(area["scale"], "square millimeters");
    EXPECT_EQ(report["observations"].size(), 1U + 4U);
    EXPECT_TRUE(report["observations"].contains("plant_1_leaf_4"));
    const auto memory = report["metadata"]["memory_bytes"]["value"].get<std::int64_t>();
    EXPECT_GT(memory, 1 << 20);
    EXPECT_LT(memory, 112 << 20);
}

TEST_F(Plant, stands_in_a_box_by_its_name_and_elsewhere_is_none)
{
    const std::string heading = "name,min_x_mm,min_y_mm,min_z_mm,max_x_mm,max_y_mm,max_z_mm\n";
    const json boxed = report(cloud_ + " --plants " + written("p.csv", heading + "aloe,-500,,10,500,,\n"));
    EXPECT_EQ(boxed["metadata"]["plant_names"]["value"]["plant_1"], "aloe");
    EXPECT_GT(boxed["observations"]["plant_1"]["leaf_count"]["value"], 0);
    const json empty = report(cloud_ + " --plants " + written("q.csv", heading + "aloe,5000,,,6000,,\n"));
    EXPECT_EQ(empty["observations"]["plant_1"]["leaf_count"]["value"], 0);

    const auto refused = [&](const std::string& text, const char* why) {
        const ToolRun run = plant(cloud_ + " --plants " + written("bad.csv", text));
        EXPECT_EQ(run.exit_code, 65) << run.output;
        EXPECT_THAT(run.output, HasSubstr(why));
    };
    refused("name,min_x_mm\na,1\n", "no column min_y_mm");
    refused(heading + "a,left,,,,,\n", "bad.csv:2: 'left' is no number of mm");
    refused(heading + "a,5,,,1,,\n", "bad.csv:2: the box of a is empty");
    refused(heading + "a,,,,,,\na,,,,,,\n", "bad.csv:3: every plant needs a name of its own");
    refused(heading, "0 plants");
}

TEST_F(Plant, in_the_colours_of_its_leaves_is_a_cloud_that_others_read)
{
    ASSERT_EQ(plant(cloud_ + " -o " + folder_.path("leaves.ply")).exit_code, 0);
    std::ifstream file(folder_.path("leaves.ply"), std::ios::binary);
    const std::string ply{std::istreambuf_iterator<char>(file), {}};
    EXPECT_THAT(ply.substr(0, 600), AllOf(HasSubstr("property ushort leaf\n"), HasSubstr("property uchar plant\n")));
    const std::size_t start = ply.find("end_header\n") + 11;
    constexpr std::size_t kVertexBytes = 22;
    ASSERT_EQ((ply.size() - start) % kVertexBytes, 0U);
    std::map<int, int> points;            // of each leaf
    std::map<int, std::string> colour_of; // one each
    for (std::size_t at = start; at < ply.size(); at += kVertexBytes) {
        const int leaf = static_cast<unsigned char>(ply[at + 19]) + 256 * static_cast<unsigned char>(ply[at + 20]);
        ++points[leaf];
        if (leaf > 0) {
            const std::string colour = ply.substr(at + 12, 3);
            EXPECT_EQ(colour_of.emplace(leaf, colour).first->second, colour);
        }
    }
    ASSERT_EQ(points.size(), 1U + 4U);
    EXPECT_NE(colour_of[1], colour_of[2]);

    ASSERT_EQ(plant(cloud_ + " -o " + folder_.path("leaves.drc")).exit_code, 0);
    const ToolRun info = test::run(std::string{DICOT_PROGRAM} + " info " + folder_.path("leaves.drc"));
    EXPECT_THAT(info.output, HasSubstr("points: 76800"));
}

TEST_F(Plant, of_a_stored_slot_is_that_of_its_cloud)
{
    test::ArchiveFolder archive(folder_.path("archive"), "bench");
    archive.done(17, "2026-06-01T12:00:00Z", cloud_);
    archive.missed(18, "2026-06-01T16:00:00Z", "the left camera is gone");
    const std::string store = " --store " + folder_.path("archive");
    json slot = report("17" + store), file = report(cloud_);
    EXPECT_EQ(slot["observations"], file["observations"]);
    const ToolRun missed = plant("18" + store);
    EXPECT_EQ(missed.exit_code, 66) << missed.output;
    EXPECT_THAT(missed.output, HasSubstr("it has no cloud"));
    const ToolRun none = plant("19" + store);
    EXPECT_EQ(none.exit_code, 66) << none.output;
}

TEST_F(Plant, is_refused_with_the_reason)
{
    const ToolRun missing = plant(folder_.path("none.drc"));
    EXPECT_EQ(missing.exit_code, 66) << missing.output;
    const ToolRun damaged = plant(written("bad.drc", "DRACO and no more"));
    EXPECT_EQ(damaged.exit_code, 65) << damaged.output;
    EXPECT_EQ(plant(cloud_ + " -o " + folder_.path("leaves.obj")).exit_code, 64);
    EXPECT_EQ(plant(cloud_ + " -o " + cloud_).exit_code, 64) << "it would write over its input";
    EXPECT_EQ(plant(cloud_ + " --csv " + folder_.path("no/folder/t.csv")).exit_code, 73);
}

TEST_F(Plant, seen_straight_from_above_is_as_high_and_as_large)
{
    for (const double down : {0.9848, 1.0}) { // 80 and 90 degrees
        test::write_plant(cloud_, {.leaves = 4, .radius_mm = kRadius_mm, .down = down});
        const json report = this->report(cloud_);
        EXPECT_EQ(report["metadata"]["ground"]["value"], "bench") << down;
        const json& plant = report["observations"]["plant_1"];
        EXPECT_NEAR(plant["height_p99_mm"]["value"].get<double>(), 60, 1) << down;
        EXPECT_NEAR(plant["leaf_area_visible_mm2"]["value"].get<double>(), 4 * kArea_mm2, 0.1 * 4 * kArea_mm2) << down;
        EXPECT_NEAR(plant["inclination_mean_deg"]["value"].get<double>(), 0, 2) << down;
        EXPECT_EQ(plant["leaf_count"]["value"], 4) << down;
    }
}

TEST_F(Plant, of_too_few_points_is_none)
{
    test::write_specks(cloud_, {.leaves = 4});
    const ToolRun run = plant(cloud_ + " -o " + folder_.path("leaves.ply"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("0 plants"), HasSubstr("too few points")));
    const std::string places =
        written("p.csv", "name,min_x_mm,min_y_mm,min_z_mm,max_x_mm,max_y_mm,max_z_mm\naloe,,,,,,\n");
    const json boxed = report(cloud_ + " --plants " + places);
    EXPECT_EQ(boxed["observations"]["plant_1"]["leaf_count"]["value"], 0);
    EXPECT_TRUE(boxed["observations"]["plant_1"]["height_p99_mm"]["value"].is_null());
}

TEST_F(Plant, without_anything_green_is_no_fault)
{
    test::write_plant(cloud_, {.leaves = 0});
    const ToolRun run = plant(cloud_ + " --csv " + folder_.path("t.csv"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("0 plants"));
    EXPECT_TRUE(table(folder_.path("t.csv")).empty());
}

} // namespace
} // namespace dicot
