// The manners of dicot match: what it refuses, how it says so, and that nothing half-made is left.
#include "noise_picture.h"
#include "temp_folder.h"
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>

namespace dicot {
namespace {

using test::Bytes;
using test::TempFolder;
using test::ToolRun;

constexpr const char* kQuick = " --window 3 --disparities 8";

struct Pair
{
    TempFolder folder;
    std::string left = folder.write("left.ppm", test::noise_ppm(40, 30, 1));
    std::string right = folder.write("right.ppm", test::noise_ppm(40, 30, 2));
    std::string output = folder.path("map.pfm");

    std::string both() const { return left + " " + right; }
};

/// What the program says on stderr alone.
ToolRun complaint(const std::string& words)
{
    return test::run("(" + std::string{DICOT_PROGRAM} + " " + words + " >/dev/null)");
}

/// Runs `match` and expects one sentence that names `named`, the exit code, and the folder as it was.
void expect_refused(const Pair& pair, const std::string& words, int exit_code, const std::string& named)
{
    const std::size_t files = pair.folder.files();
    const ToolRun run = complaint("match " + words);
    EXPECT_EQ(run.exit_code, exit_code) << words << "\n" << run.output;
    EXPECT_EQ(run.output.rfind("dicot: ", 0), 0U) << run.output;
    EXPECT_NE(run.output.find(named), std::string::npos) << words << "\n" << run.output;
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    EXPECT_EQ(pair.folder.files(), files) << words;
}

TEST(Match, BadPicturesAreNamedAndNothingIsLeft)
{
    const Pair pair;
    const TempFolder& folder = pair.folder;
    const Bytes jpeg = test::bytes_of(std::string{DICOT_PICTURE_CORPUS} + "/baseline_420.jpg");
    const std::string cut =
        folder.write("cut.jpg", Bytes(jpeg.begin(), jpeg.end() - static_cast<std::ptrdiff_t>(jpeg.size() / 3)));
    const std::string empty = folder.write("empty.png", Bytes{});
    const std::string text = folder.write("text.png", "two leaves and a stem\n");
    const std::string one = folder.write("one.ppm", test::noise_ppm(1, 1, 3));
    const std::string huge = folder.write("huge.ppm", "P6 70000 70000 255\n");
    const std::string other = folder.write("other.ppm", test::noise_ppm(40, 31, 4));
    const std::string to = std::string{kQuick} + " -o " + pair.output;
    expect_refused(pair, folder.path("gone.png") + " " + pair.right + to, 66, "gone.png");
    expect_refused(pair, pair.left + " " + folder.path("gone.png") + to, 66, "gone.png");
    expect_refused(pair, folder.path("") + " " + pair.right + to, 66, "folder");
    expect_refused(pair, empty + " " + pair.right + to, 65, "empty.png");
    expect_refused(pair, pair.left + " " + text + to, 65, "text.png");
    expect_refused(pair, cut + " " + cut + to, 65, "cut.jpg");
    expect_refused(pair, one + " " + one + to, 65, "one.ppm");
    expect_refused(pair, huge + " " + huge + to, 65, "huge.ppm");
    expect_refused(pair, pair.left + " " + other + to, 65, "other.ppm is 40 x 31");
}

TEST(Match, WordsThatMakeNoSenseAreRefused)
{
    const Pair pair;
    const std::string match = pair.both() + " -o " + pair.output;
    expect_refused(pair, match + " --disparities 900", 64, "900");
    expect_refused(pair, match + " --disparities 0", 64, "choose 1 to");
    expect_refused(pair, match + " --disparities 8 --window 4", 64, "window of 4");
    expect_refused(pair, match + " --disparities 8 --gamma-color nan", 64, "gamma-color");
    expect_refused(pair, match + " --disparities 8 --min-disparity 5000", 64, "5000");
    expect_refused(pair, pair.both() + kQuick + " -o " + pair.folder.path("map.tif"), 64, "map.tif");
    expect_refused(pair, pair.both() + " --disparities 8 --min-disparity -4 -o " + pair.folder.path("map.png"), 64,
                   "map.png");
}

TEST(Match, AnOutputIsNeverOneOfTheInputs)
{
    const Pair pair;
    const Bytes before = test::bytes_of(pair.left);
    const std::string picture = pair.folder.write("photo.png", before);
    expect_refused(pair,
                   picture + " " + pair.right + kQuick + " -o " + pair.folder.path("../") +
                       std::filesystem::path(pair.folder.path("")).parent_path().filename().string() + "/photo.png",
                   64, "named twice");
    EXPECT_EQ(test::bytes_of(picture), before);
}

TEST(Match, ARangeIsJudgedBeforeAFormatIsAdvised)
{
    const Pair pair;
    const std::string to = pair.both() + " --window 3 -o " + pair.folder.path("map.png");
    expect_refused(pair, to + " --disparities 8 --min-disparity 2147483600", 64, "leaves nothing to match");
    expect_refused(pair, to + " --disparities 1000", 64, "choose 1 to 255");
    expect_refused(pair, to + " --disparities 8 --min-disparity -4", 64, "write a .pfm");
}

TEST(Memory, ASizeThatNoPictureHasIsRefused)
{
    const Pair pair;
    const ToolRun run = complaint("memory --width 2000000000 --height 2000000000");
    EXPECT_EQ(run.exit_code, 65) << run.output;
    EXPECT_NE(run.output.find("the largest that can be matched"), std::string::npos) << run.output;
}

TEST(Match, AnUnknownWordIsAUsageError)
{
    const Pair pair;
    for (const std::string wrong : {"--method magic", "--cost much", "--cpu abacus", "--threads -1", "--quick"}) {
        const std::size_t files = pair.folder.files();
        const ToolRun run = complaint("match " + pair.both() + " -o " + pair.output + " " + wrong);
        EXPECT_EQ(run.exit_code, 64) << wrong;
        EXPECT_NE(run.output.find(wrong.substr(0, wrong.find(' '))), std::string::npos) << run.output;
        EXPECT_EQ(pair.folder.files(), files) << wrong;
    }
}

TEST(Match, AnOutputThatCannotBeWrittenIsNamedBeforeTheWorkBegins)
{
    const Pair pair;
    expect_refused(pair, pair.both() + kQuick + " -o " + pair.left + "/map.pfm", 73, "map.pfm");
    expect_refused(pair, pair.both() + kQuick + " -o " + pair.folder.path("no/map.pfm"), 73, "map.pfm");
}

TEST(Match, AFullDiskIsNamedAndNothingIsLeft)
{
    const Pair pair;
    for (const char* name : {"full.pfm", "full.png"}) {
        std::filesystem::create_symlink("/dev/full", pair.folder.path(name));
        expect_refused(pair, pair.both() + kQuick + " -o " + pair.folder.path(name), 74, "disk is full");
    }
}

TEST(Match, AFailureKeepsTheMapThatWasThereBefore)
{
    const Pair pair;
    const std::string kept = pair.folder.write("kept.pfm", "the map of yesterday");
    expect_refused(pair, pair.both() + " --disparities 900 -o " + kept, 64, "900");
    EXPECT_EQ(test::bytes_of(kept), (Bytes{'t', 'h', 'e', ' ', 'm', 'a', 'p', ' ', 'o', 'f',
                                           ' ', 'y', 'e', 's', 't', 'e', 'r', 'd', 'a', 'y'}));
}

TEST(Match, TheReportSaysWhatTheFileHolds)
{
    const Pair pair;
    const ToolRun run =
        test::run(std::string{DICOT_PROGRAM} + " match " + pair.both() + kQuick + " --json -o " + pair.output);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto report = nlohmann::json::parse(run.output);
    EXPECT_EQ(report["width"], 40);
    EXPECT_EQ(report["disparities"], 8);
    const std::string header = "Pf\n40 30\n-1.0\n";
    const Bytes map = test::bytes_of(pair.output);
    EXPECT_EQ(map.size(), header.size() + 40 * 30 * 4);
    EXPECT_TRUE(std::equal(header.begin(), header.end(), map.begin()));
}

} // namespace
} // namespace dicot
