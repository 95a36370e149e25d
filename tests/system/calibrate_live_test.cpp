// dicot calibrate --live before recorded cameras: boards that stand still one after the other.
#include "board_photos.h"
#include "temp_folder.h"
#include "tool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace dicot {
namespace {

using nlohmann::json;
using test::kBoardWords;
using test::TempFolder;
using test::ToolRun;
using testing::HasSubstr;
using testing::Not;

const std::string kDated = "SOURCE_DATE_EPOCH=1767225600 ";
/// A recorded pair is seen so many times, ten times a second: long enough to stand still.
constexpr int kStands = 10;

std::string numbered(const char* side, std::size_t number, const std::string& ending)
{
    std::string digits = std::to_string(number);
    digits.insert(0, 4 - std::min<std::size_t>(digits.size(), 4), '0');
    return side + digits + ending;
}

/// Cameras that show each of `pairs` for a second, over and over.
class Cameras
{
public:
    void show(const std::string& left, const std::string& right)
    {
        const std::string ending = std::filesystem::path(left).extension();
        for (int k = 0; k < kStands; ++k, ++shown_) {
            std::filesystem::create_symlink(left, folder_.path(numbered("left", shown_, ending)));
            std::filesystem::create_symlink(right, folder_.path(numbered("right", shown_, ending)));
        }
    }
    /// The path of a configuration with them. `more` are lines of its section of cameras.
    std::string config(const std::string& more = "") const
    {
        const std::string where = "\"replay:" + folder_.path("") + "\"\n";
        return config_.write("dicot.toml", "[cameras]\nleft = " + where + "right = " + where +
                                               "replay_script = \"rate 10\"\n" + more + "[exposure]\nwarm_up_s = 1\n");
    }

private:
    TempFolder folder_;
    TempFolder config_;
    std::size_t shown_ = 0;
};

/// A small rig before a board that was held to all sides.
class HeldBoard
{
public:
    HeldBoard()
    {
        const std::vector<test::Placement> places = test::varied_places();
        test::photograph_pairs(photos_, places);
        for (std::size_t k = 1; k <= places.size(); ++k)
            cameras_.show(photos_.path("left" + std::to_string(k) + ".pgm"),
                          photos_.path("right" + std::to_string(k) + ".pgm"));
    }
    std::string config(const std::string& more = "") const { return cameras_.config(more); }

private:
    TempFolder photos_;
    Cameras cameras_;
};

ToolRun live(const std::string& words)
{
    return test::run(kDated + DICOT_PROGRAM " calibrate --live " + words);
}

/// What a program writes to stdout alone.
ToolRun only_stdout(const std::string& words)
{
    return test::run("{ " + kDated + DICOT_PROGRAM + " " + words + " 2>/dev/null; }");
}

std::string text_of(const std::string& path)
{
    const test::Bytes bytes = test::bytes_of(path);
    return {bytes.begin(), bytes.end()};
}

std::size_t files_in(const std::string& folder)
{
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// A report without what no two runs have in common.
json without_times(json report)
{
    for (const char* name : {"found_s", "solved_s", "processor_s", "peak_memory_bytes", "output", "tables", "report"})
        report.erase(name);
    return report;
}

/// `board` is calibrated live and once more from the pairs that were kept: everything must be equal.
void expect_the_same_from_the_kept_pairs(const std::string& config, const std::string& board, int pairs)
{
    const TempFolder out;
    const std::string kept = out.path("kept");
    const ToolRun first = only_stdout("calibrate --live --config " + config + board + "--pairs " +
                                      std::to_string(pairs) + " --seconds 120 --force --json --images " + kept +
                                      " --report " + out.path("live") + " -o " + out.path("live.yaml"));
    ASSERT_EQ(first.exit_code, 0) << first.output;
    EXPECT_EQ(files_in(kept), 2U * static_cast<unsigned>(pairs));
    const ToolRun second = only_stdout("calibrate --images " + kept + board + "--force --json --report " +
                                       out.path("again") + " -o " + out.path("again.yaml"));
    ASSERT_EQ(second.exit_code, 0) << second.output;

    EXPECT_EQ(text_of(out.path("live.yaml")), text_of(out.path("again.yaml")));
    EXPECT_EQ(test::bytes_of(out.path("live.maps")), test::bytes_of(out.path("again.maps")));
    EXPECT_EQ(test::bytes_of(out.path("live/index.html")), test::bytes_of(out.path("again/index.html")));

    std::istringstream lines(first.output);
    std::vector<json> events;
    for (std::string line; std::getline(lines, line);)
        events.push_back(json::parse(line));
    ASSERT_GT(events.size(), static_cast<std::size_t>(pairs));
    EXPECT_EQ(without_times(events.back()), without_times(json::parse(second.output)));
    events.pop_back();
    EXPECT_EQ(std::ranges::count_if(events, [](const json& event) { return event.at("event") == "pair"; }), pairs);
    EXPECT_EQ(events.back().at("pairs"), pairs);
    EXPECT_EQ(events.back().at("wanted"), pairs);
}

TEST(CalibrateLive, GivesWhatItsKeptPairsGive)
{
    const HeldBoard board;
    expect_the_same_from_the_kept_pairs(board.config(), kBoardWords, 7);
}

TEST(CalibrateLive, GivesWhatItsKeptPairsGiveBeforeRealCameras)
{
    const std::string folder = DICOT_DATA_DIR "/calibration-opencv/";
    if (!std::filesystem::is_directory(folder)) {
        std::printf("NOT RUN: %s is not there\n", folder.c_str());
        return;
    }
    Cameras cameras;
    for (const char* number : {"01", "02", "03", "04", "05", "06", "07", "08", "09", "11", "12", "13", "14"})
        cameras.show(folder + "left" + number + ".jpg", folder + "right" + number + ".jpg");
    // Two of the thirteen look like others.
    expect_the_same_from_the_kept_pairs(cameras.config(), " --corners 9x6 --square-mm 30 --near-mm 250 --far-mm 550 ",
                                        11);
}

TEST(CalibrateLive, CalibratesWithThePairsOfItsTime)
{
    const HeldBoard board;
    const TempFolder out;
    const ToolRun run =
        live("--config " + board.config() + kBoardWords + "--seconds 30 --force -o " + out.path("r.yaml"));
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("the time is over: 7 of 20 pairs"));
    EXPECT_THAT(run.output, HasSubstr("7 of 7 pairs"));
    EXPECT_EQ(files_in(out.path("r-pairs")), 14U); // no board was taken twice
}

TEST(CalibrateLive, KeepsItsPairsWhenACameraDiesAndGoesOnWithThem)
{
    const HeldBoard board;
    const TempFolder out;
    const std::string words =
        kBoardWords + "--pairs 7 --force --images " + out.path("kept") + " -o " + out.path("r.yaml");
    // The third board, or the fourth one, depending on how long the warm-up takes.
    const ToolRun died = live("--config " + board.config("replay_script_right = \"gone 55\"\n") + words);
    EXPECT_EQ(died.exit_code, 69) << died.output;
    EXPECT_THAT(died.output, HasSubstr("replay/right"));
    EXPECT_THAT(died.output, HasSubstr("pairs are kept in " + out.path("kept")));
    EXPECT_THAT(died.output, HasSubstr("--resume"));
    EXPECT_FALSE(std::filesystem::exists(out.path("r.yaml")));
    const std::size_t taken = files_in(out.path("kept"));
    std::printf("%zu pictures when the camera died\n", taken);
    EXPECT_GE(taken, 2U);
    EXPECT_LT(taken, 14U);
    const test::Bytes first = test::bytes_of(out.path("kept/left01.png"));

    const ToolRun refused = live("--config " + board.config() + words);
    EXPECT_EQ(refused.exit_code, 73) << refused.output;
    EXPECT_EQ(files_in(out.path("kept")), taken);

    const ToolRun run = live("--resume --config " + board.config() + words);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_EQ(files_in(out.path("kept")), 14U);
    EXPECT_EQ(test::bytes_of(out.path("kept/left01.png")), first);
    EXPECT_THAT(run.output, HasSubstr(std::to_string(taken / 2) + " pairs are there already"));
    EXPECT_TRUE(std::filesystem::exists(out.path("r.yaml")));
}

TEST(CalibrateLive, KeepsItsPairsWhenItIsStopped)
{
    const HeldBoard board;
    const TempFolder out;
    const std::string kept = out.path("kept");
    const ToolRun run = test::run("{ " DICOT_PROGRAM " calibrate --live --config " + board.config() + kBoardWords +
                                  "--images " + kept + " -o " + out.path("r.yaml") + " & pid=$!; until [ -e " + kept +
                                  "/right02.png ]; do kill -0 $pid || break; sleep 0.1; done; kill -INT $pid; "
                                  "wait $pid; }");
    EXPECT_EQ(run.exit_code, 75) << run.output;
    EXPECT_THAT(run.output, HasSubstr("pairs are kept in " + kept));
    EXPECT_GE(files_in(kept), 4U);
    EXPECT_EQ(files_in(kept) % 2, 0U);
    EXPECT_FALSE(std::filesystem::exists(out.path("r.yaml")));
    // As the sentence says.
    const std::string command = "calibrate --images " + kept + " --corners 7x5 --square-mm 30 -o " + out.path("r.yaml");
    EXPECT_THAT(run.output, HasSubstr("dicot " + command));
}

TEST(CalibrateLive, LeavesNothingBehindWhereNoBoardIsSeen)
{
    const TempFolder photos;
    for (const char* name : {"left.pgm", "right.pgm"}) {
        std::string picture = "P5 200 150 255\n";
        for (int k = 0; k < 200 * 150; ++k)
            picture += static_cast<char>(60 + (k % 200 * 3 + k / 200 * (k / 200)) % 120);
        photos.write(name, picture);
    }
    Cameras cameras;
    cameras.show(photos.path("left.pgm"), photos.path("right.pgm"));
    const TempFolder out;
    const ToolRun run = live("--config " + cameras.config() + kBoardWords + "--seconds 3 --report " +
                             out.path("report") + " -o " + out.path("r.yaml"));
    EXPECT_EQ(run.exit_code, 75) << run.output;
    EXPECT_THAT(run.output, HasSubstr("0 pairs in 3 s are too few"));
    EXPECT_THAT(run.output, HasSubstr("show the whole board to both cameras"));
    EXPECT_EQ(out.files(), 0U);
}

TEST(CalibrateLive, RedrawsInPlaceOnATerminalAndKnowsNoColor)
{
    DICOT_NEED_TOOL("script", "bsdutils");
    const HeldBoard board;
    for (const auto& [environment, colours] :
         {std::pair{"TERM=xterm NO_COLOR=", true}, std::pair{"TERM=xterm NO_COLOR=1", false}}) {
        const TempFolder out;
        const ToolRun run = test::run(std::string(environment) +
                                      " script -qec '" DICOT_PROGRAM " calibrate --live --force --pairs 5 --config " +
                                      board.config() + kBoardWords + "-o " + out.path("r.yaml") + "' /dev/null");
        EXPECT_EQ(run.exit_code, 0) << run.output;
        EXPECT_THAT(run.output, HasSubstr("A\033[J####")) << "the block is drawn over the former one";
        EXPECT_THAT(run.output, HasSubstr("5 of 5 pairs"));
        if (colours)
            EXPECT_THAT(run.output, HasSubstr("\033[1m> "));
        else
            EXPECT_THAT(run.output, Not(HasSubstr("\033[1m")));
    }
}

TEST(CalibrateLive, RefusesWordsThatDoNotGoTogether)
{
    const TempFolder out;
    const HeldBoard board;
    const std::string end = " -o " + out.path("r.yaml");
    const auto expect_usage = [](const std::string& words, const char* sentence) {
        const ToolRun run = test::run(DICOT_PROGRAM " calibrate " + words);
        EXPECT_EQ(run.exit_code, 64) << words << "\n" << run.output;
        EXPECT_THAT(run.output, HasSubstr(sentence)) << words;
    };
    for (const char* word : {"--pairs 7", "--seconds 5", "--resume", "--config x.toml"})
        expect_usage(std::string(word) + kBoardWords + "--images x" + end, "goes with --live");
    expect_usage("--live --corners 9x6" + end, "every board needs both");
    expect_usage("--live" + kBoardWords + "--corners 9x6 --square-mm 20" + end, "one board");
    expect_usage("--live --pairs 3" + kBoardWords + end, "--pairs");
    EXPECT_EQ(
        test::run(DICOT_PROGRAM " calibrate --live --config " + out.path("none.toml") + kBoardWords + end).exit_code,
        66);
    EXPECT_EQ(out.files(), 0U);
}

} // namespace
} // namespace dicot
