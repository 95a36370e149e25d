// What a live calibration shows, and where it keeps its pairs.
#include "live/live_options.h"
#include "live/live_words.h"
#include "live/pair_folder.h"
#include "temp_folder.h"

#include "dicot/picture/read_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <sstream>

namespace dicot::app {
namespace {

using test::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

LiveMoment moment()
{
    LiveMoment now;
    now.kept = 5;
    now.wanted = 20;
    now.sight = LiveSight::kAlike;
    now.still_us = 600'000;
    now.skew_us = -1500;
    now.looks_per_s = 12.3;
    now.left_us = 61'000'000;
    now.advice = "hold the board nearer (400 to 667 mm, now about 800 mm), at the upper right of the left picture";
    now.coverage.left.corners.fill(2);
    std::fill_n(now.coverage.left.corners.begin() + 5, 3, 0);
    std::fill_n(now.coverage.left.corners.begin() + 13, 3, 0);
    now.coverage.by_distance = {0, 3, 2};
    now.coverage.by_edge = {1, 0, 4, 2};
    return now;
}

std::vector<std::string> lines_of(const std::string& text)
{
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

TEST(LiveWords, DrawTheCoverageAndTheAdvice)
{
    EXPECT_THAT(lines_of(live_block(moment(), 90, false)),
                ElementsAre("#####............... 5 of 20 pairs",                 //
                            "alike        12.3 looks/s, skew -1.5 ms, 61 s left", //
                            "left  right  distance  nearer edge",                 //
                            "##.   ...    near    0 left    1",                   //
                            "###   ...    middle  3 right   0",                   //
                            "###   ...    far     2 upper   4",                   //
                            "                       lower   2",                   //
                            "> hold the board nearer (400 to 667 mm, now about 800 mm), at the upper right of the left",
                            "  picture"));
}

TEST(LiveWords, StayWithinTheTerminalsColumns)
{
    LiveMoment now = moment();
    now.kept = 200;
    now.wanted = 200;
    now.looks_per_s = 1e4;
    now.skew_us = -99'999'999;
    now.left_us = 86'400'000'000;
    for (const int columns : {40, 55, 80, 200})
        for (const std::string& line : lines_of(live_block(now, columns, false)))
            EXPECT_LE(line.size(), static_cast<std::size_t>(columns)) << line;
}

TEST(LiveWords, HaveColoursOnlyWhereTheyAreWanted)
{
    EXPECT_THAT(live_block(moment(), 80, false), Not(HasSubstr("\033")));
    EXPECT_THAT(live_block(moment(), 80, true), HasSubstr("\033[1m> hold"));
    EXPECT_THAT(live_block(moment(), 80, true), testing::EndsWith("\033[0m\n"));
}

TEST(LiveWords, WrapAtBlanksAndLeaveLongWordsWhole)
{
    EXPECT_EQ(wrapped("one two three", 7, 2), "one two\n  three");
    EXPECT_EQ(wrapped("one two three", 13, 2), "one two three");
    EXPECT_EQ(wrapped("averyverylongword a b", 5, 1), "averyverylongword\n a b");
    EXPECT_EQ(wrapped("", 5, 1), "");
}

TEST(LiveWords, AreOneLineInAFile)
{
    EXPECT_EQ(live_line(moment()), "5 of 20 pairs, alike: hold the board nearer (400 to 667 mm, now about 800 mm), at "
                                   "the upper right of the left picture");
}

TEST(LiveWords, AreOneLineOfJson)
{
    LiveMoment now = moment();
    now.advice += " \xff\n"; // names of files may be any bytes
    const std::string line = live_json(now, "pair", "left05.png");
    EXPECT_THAT(line, Not(HasSubstr("\n")));
    const nlohmann::json json = nlohmann::json::parse(line);
    EXPECT_EQ(json["event"], "pair");
    EXPECT_EQ(json["picture"], "left05.png");
    EXPECT_EQ(json["pairs"], 5);
    EXPECT_EQ(json["wanted"], 20);
    EXPECT_EQ(json["sight"], "alike");
    EXPECT_EQ(json["still_s"], 0.6);
    EXPECT_EQ(json["skew_us"], -1500);
    EXPECT_EQ(json["missing_left"], nlohmann::json({"upper right"}));
    EXPECT_EQ(json["missing_right"].size(), 9U);
    EXPECT_EQ(json["boards_by_distance"], nlohmann::json({0, 3, 2}));
    EXPECT_EQ(json["nearer_edge"]["upper"], 4);
    EXPECT_EQ(json["covered"], false);
}

struct TwoPictures
{
    std::array<Rgb8, 6> left{{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}, {13, 14, 15}, {16, 17, 18}}};
    std::array<Rgb8, 6> right{{{9, 2, 3}, {9, 5, 6}, {9, 8, 9}, {9, 11, 12}, {9, 14, 15}, {9, 17, 18}}};

    ImageView<const Rgb8> view_of_left() const { return {left.data(), 3, 2}; }
    ImageView<const Rgb8> view_of_right() const { return {right.data(), 3, 2}; }
};

TEST(PairFolder, KeepsPairsUnderRunningNamesWithoutLoss)
{
    const TempFolder temp;
    const TwoPictures pictures;
    Result<PairFolder> folder = PairFolder::open(temp.path("pairs"), false);
    ASSERT_TRUE(folder.ok()) << folder.status().message();
    for (const char* name : {"left01.png", "left02.png"}) {
        const Status added = folder.value().add(pictures.view_of_left(), pictures.view_of_right());
        ASSERT_TRUE(added.ok()) << added.message();
        EXPECT_EQ(folder.value().last_name(), name);
    }
    std::array<Rgb8, 6> read{};
    ASSERT_TRUE(read_picture(temp.path("pairs/right02.png").c_str(), {read.data(), 3, 2}).ok());
    EXPECT_EQ(read, pictures.right);
    ASSERT_TRUE(read_picture(temp.path("pairs/left02.png").c_str(), {read.data(), 3, 2}).ok());
    EXPECT_EQ(read, pictures.left);
}

TEST(PairFolder, TakesAFolderWithPairsOnlyToGoOn)
{
    const TempFolder temp;
    const TwoPictures pictures;
    ASSERT_TRUE(PairFolder::open(temp.path("pairs"), false)
                    .value()
                    .add(pictures.view_of_left(), pictures.view_of_right())
                    .ok());
    const Result<PairFolder> refused = PairFolder::open(temp.path("pairs"), false);
    EXPECT_EQ(refused.status().fault(), Fault::kCannotCreate);
    EXPECT_THAT(refused.status().message(), HasSubstr("--resume"));
    Result<PairFolder> again = PairFolder::open(temp.path("pairs"), true);
    ASSERT_TRUE(again.ok()) << again.status().message();
    ASSERT_EQ(again.value().earlier().size(), 1U);
    EXPECT_EQ(again.value().earlier()[0].left, temp.path("pairs/left01.png"));
    ASSERT_TRUE(again.value().add(pictures.view_of_left(), pictures.view_of_right()).ok());
    EXPECT_EQ(again.value().last_name(), "left02.png");
}

TEST(PairFolder, WritesOverNothingThatIsThere)
{
    const TempFolder temp;
    const TwoPictures pictures;
    std::filesystem::create_directory(temp.path("p"));
    for (const char* name : {"left02.png", "right02.png", "right01.png"})
        std::ofstream(temp.path("p/") + name) << "something";
    Result<PairFolder> folder = PairFolder::open(temp.path("p"), true);
    ASSERT_TRUE(folder.ok()) << folder.status().message();
    ASSERT_TRUE(folder.value().add(pictures.view_of_left(), pictures.view_of_right()).ok());
    EXPECT_EQ(folder.value().last_name(), "left03.png");
}

TEST(PairFolder, LeavesNoPictureAloneWhenTheSecondCannotBeWritten)
{
    const TempFolder temp;
    const TwoPictures pictures;
    Result<PairFolder> folder = PairFolder::open(temp.path("pairs"), false);
    ASSERT_TRUE(folder.ok());
    const Status added = folder.value().add(pictures.view_of_left(), {pictures.right.data(), 0, 0}); // no PNG
    EXPECT_FALSE(added.ok());
    EXPECT_TRUE(std::filesystem::is_empty(temp.path("pairs")));
    folder.value().remove_if_empty();
    EXPECT_FALSE(std::filesystem::exists(temp.path("pairs")));
}

TEST(PairFolder, NeverRemovesAFolderThatItFound)
{
    const TempFolder temp;
    std::filesystem::create_directory(temp.path("mine"));
    Result<PairFolder> folder = PairFolder::open(temp.path("mine"), false);
    ASSERT_TRUE(folder.ok());
    folder.value().remove_if_empty();
    EXPECT_TRUE(std::filesystem::exists(temp.path("mine")));
}

TEST(PairFolder, StandsBesideTheRigFile)
{
    EXPECT_EQ(pairs_beside("rig.yaml"), "rig-pairs");
    EXPECT_EQ(pairs_beside("/a/b.c/balcony.rig.yaml"), "/a/b.c/balcony.rig-pairs");
}

TEST(LiveOptions, WantOneFolderAndOneBoard)
{
    const BoardWord corners{BoardWord::kCorners, "9x6"};
    const BoardWord square{BoardWord::kSquareMm, "30"};
    const Result<std::vector<PictureSet>> usual = read_live_words(std::array{corners, square}, "x/rig.yaml");
    ASSERT_TRUE(usual.ok()) << usual.status().message();
    EXPECT_EQ(usual.value().at(0).folder, "x/rig-pairs");
    EXPECT_EQ(usual.value().at(0).boards.at(0), (calibration::Board{9, 6, 30}));
    const Result<std::vector<PictureSet>> named =
        read_live_words(std::array{BoardWord{BoardWord::kImages, "here"}, corners, square}, "x/rig.yaml");
    ASSERT_TRUE(named.ok()) << named.status().message();
    EXPECT_EQ(named.value().at(0).folder, "here");
    EXPECT_EQ(read_live_words(std::array{corners, square, corners, square}, "r.yaml").status().fault(), Fault::kUsage);
    EXPECT_EQ(read_live_words(
                  std::array{BoardWord{BoardWord::kImages, "a"}, BoardWord{BoardWord::kImages, "b"}, corners, square},
                  "r.yaml")
                  .status()
                  .fault(),
              Fault::kUsage);
}

} // namespace
} // namespace dicot::app
