// dicot traits: an archive with misses, damage and interruptions, as a person has one.
#include "archive_folder.h"
#include "drawn_plant.h"
#include "temp_folder.h"
#include "tool.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace dicot {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ToolRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string text_of(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::vector<std::string>> rows_of(const std::string& csv)
{
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        std::vector<std::string>& row = rows.emplace_back();
        std::istringstream cells(line + ",");
        for (std::string cell; std::getline(cells, cell, ',');)
            row.push_back(cell);
    }
    return rows;
}

std::string noon(int day)
{
    char text[32];
    std::snprintf(text, sizeof text, "2026-06-%02dT10:00:00Z", day);
    return text;
}

/// Six snapshots of a plant whose four leaves grow, a miss after the third, one whose cloud was deleted on the board.
class Traits : public testing::Test
{
protected:
    Traits() : archive_(folder_.path("archive"), "bench", "Europe/Berlin")
    {
        int number = 0;
        for (int day = 1; day <= 6; ++day) {
            const std::string cloud = folder_.path("day" + std::to_string(day) + ".drc");
            test::write_plant(cloud, {.radius_mm = 10.0 + day});
            snapshots_.push_back(archive_.done(++number, noon(day), cloud));
            if (day == 3)
                archive_.missed(++number, "2026-06-03T16:00:00Z", "the left camera is gone");
        }
    }

    std::string words(const std::string& more) const
    {
        return std::string{DICOT_PROGRAM} + " traits '" + folder_.path("archive") + "' --cache '" +
               folder_.path("cache") + "' " + more;
    }
    ToolRun traits(const std::string& more = "") const { return test::run(words(more)); }
    json report(const std::string& more = "") const
    {
        const ToolRun told = test::run("{ " + words("--json " + more) + " 2>/dev/null; }");
        const json parsed = json::parse(told.output, nullptr, false);
        EXPECT_TRUE(parsed.is_object()) << told.output;
        return parsed;
    }

    test::TempFolder folder_;
    test::ArchiveFolder archive_;
    std::vector<fs::path> snapshots_;
};

TEST_F(Traits, EverySnapshotHasALinePerPlantAndAMissItsReason)
{
    const ToolRun run = traits("--csv");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto rows = rows_of(run.output);
    ASSERT_EQ(rows.size(), 1U + 7U) << run.output;
    const auto column = [&](const std::string& name) {
        const auto at = std::ranges::find(rows[0], name);
        EXPECT_NE(at, rows[0].end()) << name;
        return static_cast<std::size_t>(at - rows[0].begin());
    };
    for (const auto& row : rows)
        EXPECT_EQ(row.size(), rows[0].size());
    for (std::size_t day = 1; day <= 6; ++day) {
        const auto& row = rows[day <= 3 ? day : day + 1];
        EXPECT_EQ(row[column("device")], "bench");
        EXPECT_EQ(row[column("time")], noon(static_cast<int>(day)));
        EXPECT_EQ(row[column("local_time")], noon(static_cast<int>(day)).substr(0, 11) + "12:00:00+02:00");
        EXPECT_EQ(row[column("outcome")], "done");
        EXPECT_EQ(row[column("plant")], "1") << "it is the same plant every day";
        const double area = test::DrawnPlant{.radius_mm = 10.0 + static_cast<double>(day)}.area_mm2();
        EXPECT_NEAR(std::stod(row[column("leaf_area_visible_mm2")]), area, 0.15 * area) << day;
        EXPECT_NEAR(std::stod(row[column("leaf_count")]), 4, 0.5);
    }
    EXPECT_EQ(rows[4][column("outcome")], "missed");
    EXPECT_EQ(rows[4][column("reason")], "the left camera is gone");
    EXPECT_EQ(rows[4][column("plant")], "");
}

TEST_F(Traits, EachOfTheFourLeavesIsOneLeafAllTheTime)
{
    const ToolRun run = traits("--csv " + folder_.path("out.csv"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("plant 1: 6 snapshots"), HasSubstr("the left camera is gone")));
    const auto plants = rows_of(text_of(folder_.path("out.csv")));
    EXPECT_EQ(plants.size(), 8U);
    const auto leaves = rows_of(text_of(folder_.path("out.leaves.csv")));
    ASSERT_EQ(leaves.size(), 1U + 6U * 4U);
    const auto leaf = static_cast<std::size_t>(std::ranges::find(leaves[0], "leaf") - leaves[0].begin());
    const auto x = static_cast<std::size_t>(std::ranges::find(leaves[0], "centre_x_mm") - leaves[0].begin());
    const auto y = static_cast<std::size_t>(std::ranges::find(leaves[0], "centre_y_mm") - leaves[0].begin());
    for (std::size_t i = 5; i < leaves.size(); ++i)
        for (std::size_t first = 1; first <= 4; ++first)
            if (leaves[i][leaf] == leaves[first][leaf]) {
                EXPECT_NEAR(std::stod(leaves[i][x]), std::stod(leaves[first][x]), 5);
                EXPECT_NEAR(std::stod(leaves[i][y]), std::stod(leaves[first][y]), 5);
            }
    for (std::size_t i = 1; i < leaves.size(); ++i)
        EXPECT_LE(std::stoi(leaves[i][leaf]), 4) << "no leaf was born";
}

TEST_F(Traits, TheReportHasCurvesAndTheGap)
{
    const json board = report()["boards"].at(0);
    EXPECT_EQ(board["device"], "bench");
    EXPECT_EQ(board["timezone"], "Europe/Berlin");
    EXPECT_EQ(board["slots"], 7);
    EXPECT_EQ(board["measured"], 6);
    ASSERT_EQ(board["gaps"].size(), 1U);
    EXPECT_EQ(board["gaps"][0]["from"], noon(3));
    EXPECT_EQ(board["gaps"][0]["to"], noon(4));
    EXPECT_EQ(board["gaps"][0]["reason"], "the left camera is gone");
    const json& plant = board["plants"].at(0);
    EXPECT_EQ(plant["leaves"].size(), 4U);
    const json& area = plant["series"].at(0);
    EXPECT_EQ(area["trait"], "leaf_area_visible_mm2");
    EXPECT_EQ(area["used"], 6);
    // In the middle of the six days.
    const double rate = test::DrawnPlant{.radius_mm = 14}.area_mm2() - test::DrawnPlant{.radius_mm = 13}.area_mm2();
    const json& middle = area["curve"].at(area["curve"].size() / 2);
    EXPECT_NEAR(middle["rate_per_day"][0].get<double>(), rate, 0.15 * rate);
}

TEST_F(Traits, ADamagedCloudIsNamedAndTheRestIsDone)
{
    std::fstream cloud(snapshots_[2] / "cloud.drc", std::ios::binary | std::ios::in | std::ios::out);
    cloud.seekp(2000);
    cloud.put('?');
    cloud.close();
    const ToolRun run = traits("--csv " + folder_.path("out.csv"));
    EXPECT_EQ(run.exit_code, 65);
    EXPECT_THAT(run.output, AllOf(HasSubstr(snapshots_[2].filename().string()), HasSubstr("damaged"),
                                  HasSubstr("plant 1: 5 snapshots"), HasSubstr("1 snapshot could not be measured")));
    const auto rows = rows_of(text_of(folder_.path("out.csv")));
    ASSERT_EQ(rows.size(), 8U);
    EXPECT_THAT(testing::PrintToString(rows[3]), AllOf(HasSubstr("unread"), HasSubstr("damaged")));
    const json board = report()["boards"].at(0);
    EXPECT_EQ(board["gaps"][0]["slots"], 2) << "the damaged one and the miss after it";
}

TEST_F(Traits, WhatIsNoCloudAndMatchesItsDigestIsNamedToo)
{
    const std::string junk = folder_.path("junk");
    std::ofstream(junk) << "DRACO it is not";
    const fs::path folder = archive_.done(8, noon(8), junk);
    const ToolRun run = traits();
    EXPECT_EQ(run.exit_code, 65);
    EXPECT_THAT(run.output, AllOf(HasSubstr(folder.filename().string()), HasSubstr("plant 1: 6 snapshots")));
}

TEST_F(Traits, ANightOfAFewPointsIsAGapAndNoDamage)
{
    test::write_specks(folder_.path("night.drc"), {});
    archive_.done(8, noon(7), folder_.path("night.drc"));
    for (const char* known : {"not yet", "already"}) {
        const ToolRun run = traits("--csv " + folder_.path("out.csv"));
        EXPECT_EQ(run.exit_code, 0) << run.output;
        EXPECT_THAT(run.output, AllOf(HasSubstr("plant 1: 6 snapshots"), HasSubstr("1 slot, too few points"),
                                      Not(HasSubstr("dicot: "))))
            << known;
        const auto rows = rows_of(text_of(folder_.path("out.csv")));
        ASSERT_EQ(rows.size(), 9U);
        EXPECT_EQ(rows[8][5], "done");
        EXPECT_EQ(rows[8][6], "too few points");
    }
}

TEST_F(Traits, WhatHasNoDateIsGivenNone)
{
    test::ArchiveFolder archive(folder_.path("dateless"), "bench", "UTC", "not set");
    archive.done(1, "1970-01-01T00:02:00Z", folder_.path("day1.drc"));
    archive.missed(2, "1970-01-01T00:05:00Z", "the left camera is gone");
    const std::string command =
        std::string{DICOT_PROGRAM} + " traits " + folder_.path("dateless") + " --cache " + folder_.path("cache") + " ";
    const ToolRun run = test::run(command);
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.output, AllOf(HasSubstr("plant 1: 1 snapshot, no date"), HasSubstr("gap without a date: 1 slot"),
                                  Not(HasSubstr("1970"))));
    const json gap = json::parse(test::run(command + "--json").output).at("boards").at(0).at("gaps").at(0);
    EXPECT_TRUE(gap.at("from").is_null() && gap.at("to").is_null()) << gap;
    EXPECT_EQ(gap.at("slots"), 1);
    EXPECT_EQ(test::run(command + "--plot " + folder_.path("plots")).exit_code, 0);
}

TEST_F(Traits, AMissBeforeTheClockWasSetEndsAtTheFirstDate)
{
    test::ArchiveFolder archive(folder_.path("late"), "bench", "UTC", "not set");
    archive.missed(1, "1970-01-01T00:02:00Z", "the left camera is gone");
    archive.believe_clock("set");
    archive.done(2, noon(2), folder_.path("day1.drc"));
    archive.done(3, noon(3), folder_.path("day2.drc"));
    const std::string command =
        std::string{DICOT_PROGRAM} + " traits " + folder_.path("late") + " --cache " + folder_.path("cache") + " ";
    EXPECT_THAT(test::run(command).output,
                AllOf(HasSubstr("gap between 2026-06-02T10:00:00Z and 2026-06-02T10:00:00Z: 1 slot"),
                      Not(HasSubstr("without a date")), Not(HasSubstr("1970"))));
    const json gap = json::parse(test::run(command + "--json").output).at("boards").at(0).at("gaps").at(0);
    EXPECT_EQ(gap.at("from"), noon(2));
    EXPECT_EQ(gap.at("to"), noon(2));
}

TEST_F(Traits, AnUncertaintyThatTwoSnapshotsDoNotTellIsNotTold)
{
    test::ArchiveFolder archive(folder_.path("two"), "bench");
    archive.done(1, noon(1), folder_.path("day1.drc"));
    archive.done(2, noon(2), folder_.path("day2.drc"));
    const ToolRun run = test::run(std::string{DICOT_PROGRAM} + " traits " + folder_.path("two") + " --cache " +
                                  folder_.path("cache") + " --plot " + folder_.path("plots"));
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.output, AllOf(HasSubstr("plant 1: 2 snapshots"), testing::ContainsRegex("\n  leaves +4\\.0 *\n"),
                                  Not(HasSubstr("nan"))));
    for (const auto& plot : fs::directory_iterator(folder_.path("plots")))
        EXPECT_THAT(text_of(plot), Not(testing::ContainsRegex("[\" ,]-?nan"))) << plot;
}

TEST_F(Traits, WhoReadsThroughAPipeGetsTheWholeTable)
{
    const std::string pipe = folder_.path("pipe"), whole = folder_.path("whole.csv");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const ToolRun run = test::run("{ cat " + pipe + " > " + whole + " & timeout -s KILL 60 " + words("--csv " + pipe) +
                                  "; code=$?; wait; exit $code; }");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_EQ(rows_of(text_of(whole)).size(), 8U) << run.output;
}

TEST_F(Traits, ATextThatASpreadsheetWouldRunIsGuardedAndANumberIsNot)
{
    test::ArchiveFolder archive(folder_.path("odd"), "bench");
    archive.done(1, noon(1), folder_.path("day1.drc"));
    archive.missed(2, noon(2), "@SUM(A1), and -2");
    std::ofstream(folder_.path("places.csv"))
        << "name,min_x_mm,min_y_mm,min_z_mm,max_x_mm,max_y_mm,max_z_mm\n-basil,,,,,,\n";
    ASSERT_EQ(test::run(std::string{DICOT_PROGRAM} + " traits " + folder_.path("odd") + " --cache " +
                        folder_.path("cache") + " --plants " + folder_.path("places.csv") + " --csv " +
                        folder_.path("out.csv"))
                  .exit_code,
              0);
    const std::string csv = text_of(folder_.path("out.csv"));
    EXPECT_THAT(csv, AllOf(HasSubstr(",'-basil,"), HasSubstr(",\"'@SUM(A1), and -2\",")));
    const auto leaves = rows_of(text_of(folder_.path("out.leaves.csv")));
    EXPECT_THAT(leaves.at(1), testing::Contains("'-basil"));
    const auto x = static_cast<std::size_t>(std::ranges::find(leaves[0], "centre_x_mm") - leaves[0].begin());
    EXPECT_TRUE(std::ranges::any_of(leaves, [x](const auto& leaf) { return leaf[x].starts_with('-'); })) << csv;
}

TEST_F(Traits, ASnapshotWithoutAGroundHasNoHeights)
{
    const std::string cloud = folder_.path("thicket.drc");
    test::write_plant_in_thicket(cloud, {.radius_mm = 17});
    archive_.done(8, noon(7), cloud);
    const auto rows = rows_of(traits("--csv").output);
    ASSERT_EQ(rows.size(), 9U);
    const auto cell = [&](std::size_t row, const char* name) {
        return rows[row][static_cast<std::size_t>(std::ranges::find(rows[0], name) - rows[0].begin())];
    };
    EXPECT_NE(cell(7, "height_p99_mm"), "");
    EXPECT_EQ(cell(8, "height_p99_mm"), "");
    EXPECT_NE(cell(8, "leaf_area_visible_mm2"), "");
}

TEST_F(Traits, NothingIsMeasuredTwice)
{
    EXPECT_EQ(report()["boards"][0]["from_cache"], 0);
    const json again = report();
    EXPECT_EQ(again["boards"][0]["from_cache"], 6);
    fs::remove_all(folder_.path("cache"));
    json anew = report();
    EXPECT_EQ(anew["boards"][0]["from_cache"], 0);
    anew["boards"][0]["from_cache"] = 6;
    EXPECT_EQ(anew, again) << "the cache gives back every figure as it was";
}

TEST_F(Traits, TheNumberOfThreadsChangesNothing)
{
    const json one = report("--threads 1");
    fs::remove_all(folder_.path("cache"));
    EXPECT_EQ(report("--threads 5"), one);
}

TEST_F(Traits, ACacheThatWasCutOffOrIsNoneIsMadeAgain)
{
    const json first = report();
    const fs::path cache = folder_.path("cache/bench.traits");
    const std::string whole = text_of(cache);
    fs::resize_file(cache, whole.size() - 40); // power went while the last line was written
    EXPECT_EQ(report()["boards"][0]["from_cache"], 5);
    EXPECT_EQ(report()["boards"][0]["from_cache"], 6) << "what came behind the torn line is read";
    std::ofstream(cache) << "dicot traits 1 of another program\n" << whole.substr(whole.find('\n') + 1);
    EXPECT_EQ(report()["boards"][0]["from_cache"], 0) << "figures of another program are not mixed with its own";
    std::ofstream(cache) << std::string(5000, '\xFF');
    json anew = report();
    EXPECT_EQ(anew["boards"][0]["plants"], first["boards"][0]["plants"]);
    EXPECT_EQ(test::run(std::string{DICOT_PROGRAM} + " traits '" + folder_.path("archive") + "' --cache /dev/null/x")
                  .exit_code,
              73);
}

TEST_F(Traits, AnInterruptedRunGoesOnWhereItWas)
{
    for (int number = 8; number < 120; ++number) {
        char when[32];
        std::snprintf(when, sizeof when, "2026-07-%02dT%02d:00:00Z", 1 + number / 24, number % 24);
        archive_.done(number, when, folder_.path("day6.drc"));
    }
    const pid_t child = ::fork();
    if (child == 0) {
        ::execl(DICOT_PROGRAM, DICOT_PROGRAM, "traits", folder_.path("archive").c_str(), "--threads", "1", "--cache",
                folder_.path("cache").c_str(), "--csv", folder_.path("out.csv").c_str(), nullptr);
        ::_exit(127);
    }
    const fs::path cache = folder_.path("cache/bench.traits");
    for (int tries = 0; tries < 4000; ++tries) { // until it has kept something
        std::error_code missing;
        if (fs::file_size(cache, missing) > 2000 && !missing)
            break;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ASSERT_EQ(::kill(child, SIGINT), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 75);
    EXPECT_FALSE(fs::exists(folder_.path("out.csv"))) << "half a table is none";
    const json board = report()["boards"].at(0);
    EXPECT_EQ(board["measured"], 118);
    EXPECT_GT(board["from_cache"], 0);
    EXPECT_LT(board["from_cache"], 118);
}

TEST_F(Traits, PlotsArePicturesWithTheReasonsOfTheirGaps)
{
    const ToolRun run = traits("--plot " + folder_.path("plots"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto lacks = [](const fs::path& file, const char* words) { // the files are too long to be printed
        return text_of(file).find(words) == std::string::npos;
    };
    const std::string area = folder_.path("plots/bench_plant1_leaf_area_visible_mm2.svg");
    for (const char* words : {"<?xml", "the left camera is gone", "cm²", "2026-06-01", "06-05", "class=\"band\""})
        EXPECT_FALSE(lacks(area, words)) << words;
    const std::string page = folder_.path("plots/index.html");
    for (const char* words : {"<svg", "visible leaf area", "height", "area of each of 4 leaves"})
        EXPECT_FALSE(lacks(page, words)) << words;
    int files = 0;
    for (const auto& file : fs::directory_iterator(folder_.path("plots"))) {
        EXPECT_TRUE(lacks(file.path(), "nan")) << file.path();
        ++files;
    }
    EXPECT_GE(files, 8);
}

TEST_F(Traits, PlantsBearTheNamesOfTheirPlaces)
{
    std::ofstream(folder_.path("places.csv")) << "name,min_x_mm,min_y_mm,min_z_mm,max_x_mm,max_y_mm,max_z_mm\n"
                                                 "empty pot,-9000,-9000,0,-8000,-8000,500\nbasil,,,,,,\n";
    EXPECT_EQ(report()["boards"][0]["from_cache"], 0);
    const std::string with = "--plants " + folder_.path("places.csv");
    const json board = report(with)["boards"].at(0);
    EXPECT_EQ(board["from_cache"], 0) << "figures of other places are other figures";
    EXPECT_EQ(report(with)["boards"][0]["from_cache"], 6);
    EXPECT_EQ(report()["boards"][0]["from_cache"], 6) << "and they do not push each other out";
    ASSERT_EQ(board["plants"].size(), 2U);
    EXPECT_EQ(board["plants"][0]["name"], "empty pot");
    EXPECT_EQ(board["plants"][0]["snapshots"], 0);
    EXPECT_EQ(board["plants"][1]["name"], "basil");
    EXPECT_EQ(board["plants"][1]["snapshots"], 6);
    EXPECT_EQ(traits("--plants " + folder_.path("nowhere.csv")).exit_code, 66);
}

TEST_F(Traits, AnOutputThatCannotBeIsSaidBeforeAnythingIsMeasured)
{
    for (const char* words : {"--csv nowhere/t.csv", "--plot nowhere/plots"}) {
        EXPECT_EQ(traits(words).exit_code, 73) << words;
        EXPECT_EQ(report()["boards"][0]["from_cache"], 0) << words;
        fs::remove_all(folder_.path("cache"));
    }
}

TEST_F(Traits, TheUncertaintyOfAPlantThatDoesNotGrowIsWithinItsPicture)
{
    test::ArchiveFolder archive(folder_.path("still"), "bench");
    for (const int day : {1, 2, 3}) {
        test::write_plant(folder_.path("still.drc"), {.radius_mm = 15 + 0.01 * day, .slope = 0.7}); // steep: less sure
        archive.done(day, noon(day), folder_.path("still.drc"));
    }
    const std::string command = std::string{DICOT_PROGRAM} + " traits " + folder_.path("still") + " --cache " +
                                folder_.path("cache") + " --plot " + folder_.path("plots") + " --csv";
    const auto rows = rows_of(test::run(command).output);
    ASSERT_EQ(rows.size(), 4U);
    const auto sd = static_cast<std::size_t>(std::ranges::find(rows[0], "leaf_area_visible_mm2_sd") - rows[0].begin());
    const double sd_cm2 = std::stod(rows[1][sd]) / 100;
    EXPECT_GT(sd_cm2, 0.1);
    const std::string svg = text_of(folder_.path("plots/bench_plant1_leaf_area_visible_mm2.svg"));
    std::vector<double> marks; // of the value axis
    const std::string label = "class=\"label end\">";
    for (std::size_t at = svg.find(label); at != std::string::npos; at = svg.find(label, at + 1))
        marks.push_back(std::stod(svg.substr(at + label.size(), 12)));
    ASSERT_GE(marks.size(), 2U);
    EXPECT_GE(std::abs(marks.back() - marks.front()), 2 * sd_cm2);
}

TEST_F(Traits, WordsThatAreWrongAreRefused)
{
    EXPECT_EQ(traits("--since yesterday").exit_code, 64);
    EXPECT_EQ(traits("--timezone Nowhere/City").exit_code, 78);
    EXPECT_EQ(traits("--device nobody").exit_code, 66);
    EXPECT_EQ(traits("--threads 0").exit_code, 64);
    EXPECT_EQ(test::run(std::string{DICOT_PROGRAM} + " traits " + folder_.path("nowhere")).exit_code, 66);
    EXPECT_THAT(traits("--since 2026-06-05").output, HasSubstr("2 slots, 2 measured"));
    EXPECT_THAT(traits("--timezone UTC").output, HasSubstr("time of day in UTC"));
}

} // namespace
} // namespace dicot
