// The program itself: folders of pictures in, a rig file or a refusal out.
#include "board_photos.h"
#include "temp_folder.h"
#include "tool.h"

#include "dicot/rig/rig_file.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace dicot {
namespace {

using calibration::Board;
using test::Placement;
using test::TempFolder;
using test::ToolRun;

using test::kBoard;
using test::kBoardWords;
using test::photograph_pairs;
using test::photograph_to;
using test::small_rig;
using test::varied_places;

ToolRun dicot(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " " + words);
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// A picture without a board: stripes that differ from row to row.
void picture_of_nothing(const std::string& path, int width, int height)
{
    std::ofstream file(path, std::ios::binary);
    file << "P5 " << width << " " << height << " 255\n";
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            file.put(static_cast<char>(60 + (x * 3 + y * y) % 120));
}

/// Runs calibrate over a rig file that is there already; the exit code and the sentence must be these, and the file
/// must keep its bytes.
void expect_refusal(const std::string& words, int exit_code, const std::string& sentence)
{
    const TempFolder out;
    const std::string rig = out.write("rig.yaml", std::string("what was there before"));
    const ToolRun run = dicot("calibrate " + words + " -o " + rig);
    EXPECT_EQ(run.exit_code, exit_code) << words << "\n" << run.output;
    EXPECT_TRUE(contains(run.output, sentence)) << words << "\n" << run.output;
    const test::Bytes bytes = test::bytes_of(rig);
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "what was there before") << words;
    EXPECT_EQ(out.files(), 1U) << words;
}

std::string in(const TempFolder& folder)
{
    return "--images " + folder.path("");
}

bool real_pairs_there()
{
    if (std::filesystem::is_directory(DICOT_DATA_DIR "/calibration-opencv"))
        return true;
    std::printf("NOT RUN: %s is not there\n", DICOT_DATA_DIR "/calibration-opencv");
    return false;
}

const std::string kRealPairs = "--images " DICOT_DATA_DIR "/calibration-opencv --corners 9x6 --square-mm 30 ";

TEST(CalibrateCommand, FindsAllRealPairsAndWritesARigThatLoads)
{
    if (!real_pairs_there())
        return;
    const TempFolder folder;
    const std::string rig = folder.path("rig.yaml");
    const ToolRun run = dicot("calibrate " + kRealPairs + "--near-mm 250 --far-mm 550 --report " +
                              folder.path("report") + " -o " + rig);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_TRUE(std::filesystem::exists(folder.path("report/index.html"))) << run.output;
    EXPECT_TRUE(contains(run.output, "13 of 13 pairs")) << run.output;
    EXPECT_TRUE(contains(run.output, "verdict: ")) << run.output;
    const RigFile read = read_rig_file(rig.c_str()).value();
    EXPECT_EQ(read.width, 640);
    EXPECT_EQ(read.height, 480);
    EXPECT_EQ(read.left.distortion->count, 5);
    EXPECT_NEAR((*read.translation_mm)[0], -99.81, 0.3); // OpenCV 4.6 on the same pictures
    EXPECT_NEAR((*read.left.intrinsic)[0][0], 533.56, 1.5);
    EXPECT_EQ(read.near_mm, 250);
    EXPECT_EQ(read.far_mm, 550);
    EXPECT_TRUE(read.left.rectifying && read.right.projection && read.reprojection);
    const ToolRun shown = dicot("rig show " + rig);
    EXPECT_EQ(shown.exit_code, 0) << shown.output;
    EXPECT_TRUE(contains(shown.output, "as the cameras give them")) << shown.output;
    EXPECT_TRUE(contains(shown.output, "13 pairs from 2")) << shown.output;
    EXPECT_TRUE(contains(shown.output, "calibrated at 20")) << shown.output;
    EXPECT_EQ(std::string(read.id).rfind("rig-", 0), 0U) << read.id;
    ASSERT_TRUE(read.quality);
    const ToolRun as_json = dicot("rig show --json " + rig);
    const nlohmann::json json = nlohmann::json::parse(as_json.output);
    EXPECT_EQ(json["quality"]["pairs"], 13);
    EXPECT_EQ(json["quality"]["rms_px"].get<double>(), read.quality->rms_px);
    EXPECT_EQ(json["calibrated_at"], read.calibrated_at);
}

TEST(CalibrateCommand, WritesTheSameBytesWithAnyNumberOfThreads)
{
    if (!real_pairs_there())
        return;
    const TempFolder folder;
    const std::string dated = "SOURCE_DATE_EPOCH=1767225600 " DICOT_PROGRAM " calibrate " + kRealPairs;
    ASSERT_EQ(test::run(dated + "--threads 1 -o " + folder.path("1.yaml")).exit_code, 0);
    ASSERT_EQ(test::run(dated + "--threads 2 -o " + folder.path("2.yaml")).exit_code, 0);
    EXPECT_EQ(test::bytes_of(folder.path("1.yaml")), test::bytes_of(folder.path("2.yaml")));
    EXPECT_STREQ(read_rig_file(folder.path("1.yaml").c_str()).value().calibrated_at, "2026-01-01T00:00:00Z");
}

TEST(CalibrateCommand, NamesEachPairThatIsNotUsedAndGoesOn)
{
    const TempFolder folder;
    const StereoRig rig = small_rig();
    photograph_pairs(folder, varied_places());
    // 8: damaged. 9: cut off in the right picture. 10: without a partner.
    test::Bytes damaged = test::bytes_of(folder.path("left1.pgm"));
    damaged.resize(damaged.size() / 2);
    folder.write("left8.pgm", damaged);
    std::filesystem::copy(folder.path("right1.pgm"), folder.path("right8.pgm"));
    const Placement cut{test::turn_about(10, 5, 0), {-150, 0, 420}};
    photograph_to(folder.path("left9.pgm"), rig, false, kBoard, {cut.turn, {-40, 0, 420}});
    photograph_to(folder.path("right9.pgm"), rig, true, kBoard, cut);
    std::filesystem::copy(folder.path("left1.pgm"), folder.path("left10.pgm"));

    const std::string out = folder.path("rig.yaml");
    const ToolRun run = dicot("calibrate " + in(folder) + kBoardWords + "--json --force -o " + out);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const nlohmann::json report = nlohmann::json::parse(run.output);
    EXPECT_EQ(report["pairs_used"], 7);
    ASSERT_EQ(report["pairs"].size(), 9U);
    EXPECT_EQ(report["pairs"][7]["used"], false);
    EXPECT_TRUE(contains(report["pairs"][7]["reason"], "left8.pgm: ")) << report["pairs"][7];
    EXPECT_TRUE(contains(report["pairs"][7]["reason"], "cut short")) << report["pairs"][7];
    EXPECT_EQ(report["pairs"][8]["used"], false);
    EXPECT_TRUE(contains(report["pairs"][8]["reason"], "right9.pgm: ")) << report["pairs"][8];
    EXPECT_TRUE(contains(report["pairs"][8]["reason"], "board cut off on the left")) << report["pairs"][8];
    EXPECT_EQ(report["alone"][0]["picture"], "left10.pgm");
    EXPECT_LT(report["rms_px"], 0.15);
    EXPECT_NEAR(report["baseline_mm"].get<double>(), rig.baseline_mm(), 0.6);
    EXPECT_NEAR(report["left"]["fx_px"].get<double>(), rig.left.fx, 2.0);
    EXPECT_TRUE(read_rig_file(out.c_str()).ok());
}

TEST(CalibrateCommand, TakesSeveralBoardsInOneRun)
{
    const TempFolder folder;
    const StereoRig rig = small_rig();
    const Board other{6, 6, 26};
    for (const char* name : {"a", "b", "mixed"})
        std::filesystem::create_directory(folder.path(name));
    const std::vector<Placement> places = varied_places();
    for (std::size_t k = 0; k < places.size(); ++k) {
        const bool first = k % 2 == 0;
        for (const bool right : {false, true}) {
            const std::string name = (right ? "/right" : "/left") + std::to_string(k) + ".pgm";
            photograph_to(folder.path((first ? "a" : "b") + name), rig, right, first ? kBoard : other, places[k]);
            std::filesystem::copy(folder.path((first ? "a" : "b") + name), folder.path("mixed" + name));
        }
    }
    const std::string two = " --squares 7x7 --square-mm 26 --force ";
    const std::string apart = "--images " + folder.path("a") + kBoardWords + "--images " + folder.path("b") + two;
    const std::string mixed = "--images " + folder.path("mixed") + kBoardWords + two;
    for (const std::string& words : {apart, mixed}) {
        const ToolRun run = dicot("calibrate " + words + "--json -o " + folder.path("rig.yaml"));
        ASSERT_EQ(run.exit_code, 0) << run.output;
        const nlohmann::json report = nlohmann::json::parse(run.output);
        EXPECT_EQ(report["pairs_used"], 7) << words;
        EXPECT_EQ(report["boards"].size(), 2U) << words;
        EXPECT_NEAR(report["baseline_mm"].get<double>(), rig.baseline_mm(), 0.6) << words;
    }
}

TEST(CalibrateCommand, AVerdictOfRedoIsNotWrittenUnlessForced)
{
    const TempFolder folder;
    std::vector<Placement> places = varied_places();
    places.resize(5); // six are the least for "usable"
    photograph_pairs(folder, places);
    expect_refusal(in(folder) + kBoardWords, 65, "the verdict is redo: 5 pairs were used: take at least 10");
    const std::string out = folder.path("rig.yaml");
    // The page tells why, but takes no other page's place.
    const std::string report = folder.path("report");
    EXPECT_EQ(dicot("calibrate " + in(folder) + kBoardWords + "--report " + report + " -o " + out).exit_code, 65);
    EXPECT_TRUE(std::filesystem::exists(report + "/index.html"));
    EXPECT_FALSE(std::filesystem::exists(out));
    folder.write("report/index.html", std::string("an earlier page"));
    EXPECT_EQ(dicot("calibrate " + in(folder) + kBoardWords + "--report " + report + " -o " + out).exit_code, 65);
    EXPECT_EQ(test::bytes_of(report + "/index.html").size(), 15U);
    const ToolRun forced = dicot("calibrate " + in(folder) + kBoardWords + "--force -o " + out);
    EXPECT_EQ(forced.exit_code, 0) << forced.output;
    EXPECT_TRUE(contains(forced.output, "verdict: redo")) << forced.output;
    EXPECT_TRUE(read_rig_file(out.c_str()).ok());
}

TEST(CalibrateRefusal, SaysThatNoPictureShowsABoard)
{
    const TempFolder folder;
    for (const char* name : {"left1.pgm", "right1.pgm", "left2.pgm", "right2.pgm"})
        picture_of_nothing(folder.path(name), 200, 150);
    expect_refusal(in(folder) + kBoardWords, 65, "no board found in any of 4 pictures; most of them: no chessboard");
}

TEST(CalibrateRefusal, SaysWhichBoardIsThereInstead)
{
    const TempFolder folder;
    std::vector<Placement> places = varied_places();
    places.resize(2);
    photograph_pairs(folder, places);
    expect_refusal(in(folder) + " --corners 6x5 --square-mm 30", 65, "at least 7 x 5 inner corners, not 6 x 5");
    expect_refusal(in(folder) + " --corners 8x5 --square-mm 30", 65, "7 of 8 columns found");
    expect_refusal(in(folder) + " --corners 7x7 --square-mm 30", 65, "5 of 7 rows found");
}

TEST(CalibrateRefusal, SaysThatAllViewsAreAlike)
{
    const TempFolder folder;
    std::vector<Placement> places;
    for (int k = 0; k < 5; ++k)
        places.push_back({test::turn_about(12, 8, 0), {-60.0 + 40 * k, -30.0 + 15 * k, 460}});
    photograph_pairs(folder, places);
    expect_refusal(in(folder) + kBoardWords, 65, "all views are alike");
    expect_refusal(in(folder) + kBoardWords + "--force", 65, "by 20 to 40 degrees to all four sides");
}

TEST(CalibrateRefusal, SaysThatTheCamerasAreSwapped)
{
    const TempFolder folder;
    photograph_pairs(folder, varied_places(), "right", "left");
    expect_refusal(in(folder) + kBoardWords, 65, "left and right are swapped");
}

TEST(CalibrateRefusal, SaysThatThereAreTooFewPairs)
{
    const TempFolder folder;
    std::vector<Placement> places = varied_places();
    places.resize(3);
    photograph_pairs(folder, places);
    expect_refusal(in(folder) + kBoardWords, 65,
                   "3 pairs show the whole board in both pictures; at least 4 are needed");
}

TEST(CalibrateRefusal, NamesThePictureOfAnotherSize)
{
    const TempFolder folder;
    for (const char* name : {"left1.pgm", "right1.pgm", "left2.pgm"})
        picture_of_nothing(folder.path(name), 200, 150);
    picture_of_nothing(folder.path("right2.pgm"), 160, 120);
    expect_refusal(in(folder) + kBoardWords, 65, "right2.pgm is 160 x 120 px, other pictures are 200 x 150");
}

TEST(CalibrateRefusal, SaysThatPicturesAreMissing)
{
    const TempFolder folder;
    for (const char* name : {"none", "one"})
        std::filesystem::create_directory(folder.path(name));
    for (const char* name : {"one/left1.pgm", "one/left2.pgm"})
        picture_of_nothing(folder.path(name), 200, 150);
    expect_refusal("--images " + folder.path("none") + kBoardWords, 66, "no PNG, JPEG or PPM pictures");
    expect_refusal("--images " + folder.path("absent") + kBoardWords, 66, "No such file");
    expect_refusal("--images " + folder.path("one") + kBoardWords, 66,
                   "2 pictures of the left camera and none of the right");
}

TEST(CalibrateRefusal, SaysWhichWordsAreWrong)
{
    const TempFolder folder;
    for (const char* name : {"left1.pgm", "right1.pgm"})
        picture_of_nothing(folder.path(name), 200, 150);
    for (const char* corners : {"9", "9x", "1000x1000"})
        expect_refusal(in(folder) + " --corners " + corners + " --square-mm 30", 64,
                       corners[1] == '0' ? "1000" : "9x6");
    for (const char* square : {"0", "-3", "nan"})
        expect_refusal(in(folder) + " --corners 9x6 --square-mm " + square, 64, square);
    expect_refusal(in(folder), 64, "which board");
    expect_refusal(in(folder) + " --corners 9x6", 64, "every board needs both");
    expect_refusal(in(folder) + kBoardWords + "--near-mm 900 --far-mm 400", 64, "--near-mm");
    EXPECT_EQ(dicot("calibrate " + in(folder) + kBoardWords).exit_code, 64) << "without an output";
}

TEST(CalibrateRefusal, LooksAtTheOutputBeforeTheWork)
{
    const TempFolder folder;
    for (const char* name : {"left1.pgm", "right1.pgm"})
        picture_of_nothing(folder.path(name), 200, 150);
    const std::string words = "calibrate " + in(folder) + kBoardWords + "-o ";
    EXPECT_EQ(dicot(words + folder.path("absent/rig.yaml")).exit_code, 73);
    EXPECT_EQ(dicot(words + folder.path("rig.yaml") + " --report " + folder.path("absent/report")).exit_code, 73);
    EXPECT_EQ(dicot(words + folder.path("rig.yaml") + " --report " + folder.path("")).exit_code, 64);
    const test::Bytes before = test::bytes_of(folder.path("left1.pgm"));
    EXPECT_EQ(dicot(words + folder.path("left1.pgm")).exit_code, 64);
    EXPECT_EQ(test::bytes_of(folder.path("left1.pgm")), before);
    EXPECT_EQ(folder.files(), 2U);
}

TEST(CalibrateRefusal, KeepsTheFormerRigWhereItsTablesCannotStand)
{
    const TempFolder folder;
    photograph_pairs(folder, varied_places());
    const TempFolder out;
    const std::string rig = out.write("rig.yaml", std::string("what was there before"));
    std::filesystem::create_directory(out.path("rig.maps"));
    const ToolRun run = dicot("calibrate --force " + in(folder) + kBoardWords + "-o " + rig);
    EXPECT_EQ(run.exit_code, 73) << run.output;
    EXPECT_TRUE(contains(run.output, "rig.maps")) << run.output;
    const test::Bytes bytes = test::bytes_of(rig);
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "what was there before");
    EXPECT_EQ(dicot("calibrate --force " + in(folder) + kBoardWords + "-o " + out.path("other.maps")).exit_code, 64);
}

TEST(CalibrateCommand, WritesToAPipeWithoutTables)
{
    const TempFolder folder;
    photograph_pairs(folder, varied_places());
    const ToolRun run = dicot("calibrate --force " + in(folder) + kBoardWords + "-o /dev/stdout");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_TRUE(contains(run.output, "calibration_time")) << run.output;
    EXPECT_FALSE(std::filesystem::exists("/dev/stdout.maps"));
}

TEST(CalibrateCommand, TellsFoldersOfOneNameApart)
{
    const TempFolder folder;
    for (const char* name : {"p/x", "q/x"})
        std::filesystem::create_directories(folder.path(name));
    for (const char* name : {"p/x/left1.pgm", "p/x/right1.pgm", "q/x/left1.pgm", "q/x/right1.pgm"})
        picture_of_nothing(folder.path(name), 200, 150);
    const ToolRun run = dicot("calibrate --images " + folder.path("p/x") + " --images " + folder.path("q/x") +
                              kBoardWords + "-o " + folder.path("rig.yaml"));
    EXPECT_EQ(run.exit_code, 65);
    EXPECT_TRUE(contains(run.output, "p/x/left1.pgm") && contains(run.output, "q/x/left1.pgm")) << run.output;
}

TEST(CalibrateCommand, TheBowBelongsToOneBoard)
{
    const TempFolder folder;
    const ToolRun run = dicot("calibrate --fit-warp " + in(folder) +
                              " --corners 7x5 --square-mm 30 --corners 9x6 "
                              "--square-mm 20 -o " +
                              folder.path("rig.yaml"));
    EXPECT_EQ(run.exit_code, 64);
    EXPECT_TRUE(contains(run.output, "bow of one board")) << run.output;
}

} // namespace
} // namespace dicot
