#include "board_words.h"
#include "pair_files.h"
#include "picture_name.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

using Names = std::vector<std::string>;
using test::TempFolder;

/// "left|right" of each pair.
Names pairs_of(const Names& names)
{
    Names joined;
    for (const PicturePair& pair : pair_names(names).pairs)
        joined.push_back(pair.left + "|" + pair.right);
    return joined;
}

struct Spelling
{
    const char* left;
    const char* right;
};

class PairSpelling : public testing::TestWithParam<Spelling>
{
};

TEST_P(PairSpelling, IsAPairAndNothingIsLeft)
{
    const auto& [left, right] = GetParam();
    EXPECT_EQ(pairs_of({right, left}), Names{std::string(left) + "|" + right});
    EXPECT_TRUE(pair_names(Names{right, left}).alone.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Usual, PairSpelling,
    testing::Values(Spelling{"left01.jpg", "right01.jpg"}, Spelling{"0001_left.png", "0001_right.png"},
                    Spelling{"left_00.jpg", "right_00.jpg"}, Spelling{"left/0001.png", "right/0001.png"},
                    Spelling{"LEFT01.JPG", "Right01.jpg"}, Spelling{"l7.ppm", "r7.ppm"}, Spelling{"7-L.png", "7-R.png"},
                    Spelling{"cam0_12.png", "cam1_12.png"}, Spelling{"cam1_12.png", "cam2_12.png"},
                    Spelling{"cam_0-12.png", "cam_1-12.png"}, Spelling{"camera0/3.png", "camera1/3.png"},
                    Spelling{"camera_left_3.jpeg", "camera_right_3.jpeg"}, Spelling{"imgLeft3.png", "imgRight3.png"},
                    Spelling{"leftImg3.png", "rightImg3.png"}, Spelling{"camL03.png", "camR03.png"},
                    Spelling{"left1.jpg", "right01.jpg"}, Spelling{"left01.png", "right01.jpg"},
                    Spelling{"left.png", "right.png"}, Spelling{"left/left_1.png", "right/right_1.png"},
                    Spelling{"left/cam0_1.png", "right/cam1_1.png"}, Spelling{"left_r01.png", "right_r01.png"},
                    Spelling{"2026-03-01 left.png", "2026-03-01 right.png"}));

TEST(PairNames, ComeInTheOrderOfTheirNumbers)
{
    EXPECT_EQ(pairs_of({"right10.png", "left9.png", "left10.png", "right9.png", "left2.png", "right2.png"}),
              (Names{"left2.png|right2.png", "left9.png|right9.png", "left10.png|right10.png"}));
}

TEST(PairNames, DoNotDependOnTheOrderOfTheFolder)
{
    Names names;
    for (int k = 0; k < 40; ++k)
        for (const char* side : {"left", "right", "l_", "R"})
            for (const char* ending : {".png", ".jpg"})
                if ((k * 7 + ending[1]) % 5 != 0)
                    names.push_back(side + std::to_string(k) + ending);
    const PairedNames first = pair_names(names);
    std::mt19937 random(7);
    for (int round = 0; round < 20; ++round) {
        std::shuffle(names.begin(), names.end(), random);
        const PairedNames again = pair_names(names);
        EXPECT_EQ(again.pairs, first.pairs) << "round " << round;
        EXPECT_EQ(again.alone, first.alone) << "round " << round;
    }
}

TEST(PairNames, WhatHasNoPartnerIsNamedWithTheReason)
{
    const PairedNames names = pair_names(Names{"left01.jpg", "right02.jpg", "board.jpg", "left_to_right.jpg"});
    EXPECT_TRUE(names.pairs.empty());
    EXPECT_EQ(names.lefts, 1);
    EXPECT_EQ(names.rights, 1);
    EXPECT_EQ(names.alone, (std::vector<LonePicture>{{"board.jpg", "its name says neither left nor right"},
                                                     {"left01.jpg", "no right picture of this number"},
                                                     {"left_to_right.jpg", "its name says both left and right"},
                                                     {"right02.jpg", "no left picture of this number"}}));
}

TEST(PairNames, WordsThatOnlyContainASideSayNothing)
{
    EXPECT_TRUE(pairs_of({"bright1.png", "cleft1.png", "upright1.png", "lr1.png", "cam3_1.png"}).empty());
}

TEST(PairNames, ANumberMakesOnePair)
{
    // The same picture twice, as PNG and as JPEG, must not count twice.
    EXPECT_EQ(pairs_of({"left01.jpg", "left01.png", "right01.jpg", "right01.png"}), Names{"left01.png|right01.png"});
    EXPECT_EQ(pairs_of({"left01.jpg", "left01.png", "right01.jpg"}), Names{"left01.jpg|right01.jpg"});
    // Equal spellings belong together; what differs in zeros is left.
    const PairedNames zeros = pair_names(Names{"left1.jpg", "left01.jpg", "right01.jpg"});
    ASSERT_EQ(zeros.pairs.size(), 1U);
    EXPECT_EQ(zeros.pairs.front(), (PicturePair{"left01.jpg", "right01.jpg"}));
    EXPECT_EQ(zeros.alone, (std::vector<LonePicture>{{"left1.jpg", "left01.jpg has the same number"}}));
    // Nothing tells which of the two is meant.
    EXPECT_TRUE(pairs_of({"left1.jpg", "left01.jpg", "right001.jpg"}).empty());
}

TEST(PairNames, OfHostileFilesAreJustNames)
{
    const std::string digits(250, '9');
    const Names names{"left" + digits + ".png",
                      "right" + digits + ".png",
                      "left\x01\x1b[2J.png",
                      "right\x01\x1b[2J.png",
                      "left\xff\xfe.png",
                      "right\xff\xfe.png",
                      "left*.png",
                      "*left.png",
                      ".png",
                      "/",
                      "",
                      "left",
                      "a..png"};
    EXPECT_EQ(pair_names(names).pairs.size(), 3U);
    EXPECT_EQ(pair_names(names).pairs.size() * 2 + pair_names(names).alone.size(), names.size());
}

TEST(PairNames, ThousandsTakeNoTime)
{
    Names names;
    for (int k = 0; k < 20000; ++k) {
        names.push_back("left" + std::to_string(k) + ".png");
        names.push_back("right" + std::to_string(k) + ".png");
    }
    // All of one number.
    for (std::size_t zeros = 0; zeros < 4000; ++zeros)
        names.push_back("l" + std::string(zeros, '0') + "7.jpg");
    const PairedNames paired = pair_names(names);
    EXPECT_EQ(paired.pairs.size(), 20000U);
    EXPECT_EQ(paired.pairs[9].left, "left9.png");
    EXPECT_EQ(paired.pairs[10].left, "left10.png");
    EXPECT_EQ(paired.alone.size(), 4000U);
}

TEST(NameOrder, IsStrictAndCountsNumbers)
{
    const Names sorted{"", "01", "1", "2", "10", "a", "a1", "a1b", "a2", "a10", "b"};
    for (std::size_t i = 0; i < sorted.size(); ++i)
        for (std::size_t j = 0; j < sorted.size(); ++j)
            EXPECT_EQ(before(sorted[i], sorted[j]), i < j) << sorted[i] << " " << sorted[j];
}

void touch(const TempFolder& folder, const Names& names)
{
    for (const std::string& name : names) {
        std::filesystem::create_directories(std::filesystem::path(folder.path(name)).parent_path());
        folder.write(name, std::string("x"));
    }
}

TEST(FolderPairs, LooksAtPicturesByTheirEndingsAlone)
{
    const TempFolder folder;
    touch(folder, {"left1.png", "right1.png", "left2.yaml", "right2.yaml", ".left3.png", "right3.png", "notes.txt"});
    const auto names = pairs_in_folder(folder.path("."));
    ASSERT_TRUE(names.ok()) << names.status().message();
    EXPECT_EQ(names.value().pairs, (std::vector<PicturePair>{{"left1.png", "right1.png"}}));
    EXPECT_EQ(names.value().alone.size(), 1U);
}

TEST(FolderPairs, LooksIntoTheFoldersOfTheTwoSidesAndIntoNoOthers)
{
    for (const auto& [left, right] : {Spelling{"left", "right"}, Spelling{"L", "R"}, Spelling{"cam0", "cam1"},
                                      Spelling{"cam1", "cam2"}, Spelling{"camera_left", "camera_right"}}) {
        const TempFolder folder;
        touch(folder, {std::string(left) + "/0002.png", std::string(right) + "/0002.png", "board_b/left1.png",
                       "board_b/right1.png"});
        const auto names = pairs_in_folder(folder.path(""));
        ASSERT_TRUE(names.ok()) << left << ": " << names.status().message();
        ASSERT_EQ(names.value().pairs.size(), 1U) << left;
        EXPECT_EQ(names.value().pairs.front().left, std::string(left) + "/0002.png");
        EXPECT_EQ(names.value().pairs.front().right, std::string(right) + "/0002.png");
    }
}

TEST(FolderPairs, SaysWhyThereAreNone)
{
    const TempFolder folder;
    touch(folder, {"empty/notes.txt", "boards/a/left1.png", "one/left1.png", "one/left2.png", "named/a.png"});
    const auto why = [&](const char* name) {
        const auto names = pairs_in_folder(folder.path(name));
        EXPECT_EQ(names.status().fault(), Fault::kNoInput) << name;
        return std::string(names.status().message());
    };
    EXPECT_NE(why("missing").find("No such file"), std::string::npos);
    EXPECT_NE(why("empty/notes.txt").find("is no folder"), std::string::npos);
    EXPECT_NE(why("empty").find("no PNG, JPEG or PPM pictures"), std::string::npos);
    EXPECT_NE(why("boards").find("--images"), std::string::npos);
    EXPECT_NE(why("one").find("2 pictures of the left camera and none of the right one"), std::string::npos);
    EXPECT_NE(why("named").find("a.png: its name says neither"), std::string::npos);
}

using Word = BoardWord;
using Board = calibration::Board;

/// "folder: board board; ..." of what the words mean, or the sentence.
std::string meaning(const std::vector<Word>& words)
{
    const auto sets = read_board_words(words);
    if (!sets.ok())
        return std::string("refused: ") + sets.status().message();
    std::string all;
    for (const PictureSet& set : sets.value()) {
        all += set.folder + ":";
        for (const Board& board : set.boards)
            all += " " + std::to_string(board.cols) + "x" + std::to_string(board.rows) + "@" +
                   std::to_string(static_cast<int>(board.square_mm));
        all += ";";
    }
    return all;
}

TEST(BoardWords, ABoardBelongsToTheFoldersBeforeIt)
{
    const Word a{Word::kImages, "A"}, b{Word::kImages, "B"}, nine{Word::kCorners, "9x9"}, s41{Word::kSquareMm, "41"},
        eight{Word::kSquares, "8x8"}, s46{Word::kSquareMm, "46"};
    EXPECT_EQ(meaning({a, nine, s41}), "A: 9x9@41;");
    EXPECT_EQ(meaning({s41, nine, a}), "A: 9x9@41;");
    EXPECT_EQ(meaning({a, nine, s41, b, eight, s46}), "A: 9x9@41;B: 7x7@46;");
    EXPECT_EQ(meaning({a, b, nine, s41}), "A: 9x9@41;B: 9x9@41;");
    EXPECT_EQ(meaning({nine, s41, a, b}), "A: 9x9@41;B: 9x9@41;");
    EXPECT_EQ(meaning({a, nine, s41, eight, s46}), "A: 9x9@41 7x7@46;");
    EXPECT_EQ(meaning({a, b, nine, eight, s41, s46}), "A: 9x9@41 7x7@46;B: 9x9@41 7x7@46;");
    for (const auto& words : std::vector<std::vector<Word>>{{},
                                                            {nine, s41},
                                                            {a},
                                                            {a, nine},
                                                            {a, s41},
                                                            {a, nine, s41, b},
                                                            {nine, s41, a, eight, s46},
                                                            {a, nine, s41, s46}})
        EXPECT_EQ(meaning(words).rfind("refused: ", 0), 0U) << meaning(words);
}

TEST(BoardWords, NumbersThatAreNoneAreRefused)
{
    for (const char* corners :
         {"9", "9x", "x6", "", "9x6x5", "9 x 6", "9x6 ", "9.0x6", "1000x1000", "2x2", "-9x6", "99999999999999999999x6",
          "9\xc3\x97"
          "6"})
        EXPECT_EQ(
            meaning({{Word::kImages, "A"}, {Word::kCorners, corners}, {Word::kSquareMm, "30"}}).rfind("refused", 0), 0U)
            << corners;
    for (const char* square : {"0", "-3", "nan", "inf", "", "30mm", "1e300", "0x1p4"})
        EXPECT_EQ(
            meaning({{Word::kImages, "A"}, {Word::kCorners, "9x6"}, {Word::kSquareMm, square}}).rfind("refused", 0), 0U)
            << square;
}

} // namespace
} // namespace dicot::app
