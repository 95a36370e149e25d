// The program itself before recorded cameras: snapshots and captures, whole or missed with a reason.
#include "cameras/drawn_pair.h"
#include "cloud_on_disk.h"
#include "temp_folder.h"
#include "tool.h"

#include "dicot/base/utc_time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace dicot {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Bytes;
using test::ToolRun;
using testing::ElementsAre;
using testing::HasSubstr;

ToolRun dicot(const std::string& words)
{
    return test::run(std::string{DICOT_PROGRAM} + " " + words);
}

json json_in(const std::string& output)
{
    const std::size_t begin = output.find("{\n");
    return begin == std::string::npos ? json::object() : json::parse(output.substr(begin));
}

json json_file(const fs::path& path)
{
    std::ifstream file(path);
    return json::parse(file);
}

Bytes bytes_of(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Point by point; a point has no padding.
bool same_points(const PointCloud& a, const PointCloud& b)
{
    return a.grid.step_um == b.grid.step_um && std::ranges::equal(a.grid.origin, b.grid.origin) &&
           std::ranges::equal(std::as_bytes(a.points), std::as_bytes(b.points));
}

/// Folders of snapshots below a store's root, in the order of their numbers.
std::vector<fs::path> snapshots_in(const fs::path& root)
{
    std::vector<fs::path> folders;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root))
        if (entry.path().filename() == "record.json")
            folders.push_back(entry.path().parent_path());
    std::sort(folders.begin(), folders.end());
    return folders;
}

std::vector<std::string> names_in(const fs::path& folder)
{
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

/// The drawn pair as a folder of recorded pictures with a rig file, and configurations that name it.
class Recorded : public testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        folder_ = new test::TempFolder;
        app::Config config;
        app::DrawnRig drawn;
        ASSERT_TRUE(drawn.open(config).ok());
        const fs::path from = config.cameras.left.what;
        fs::create_directory(folder_->path("pairs"));
        for (const char* side : {"left", "right"})
            fs::copy(from / (std::string(side) + ".png"), folder_->path(std::string("pairs/") + side + "01.png"));
        fs::copy(config.rig.file, folder_->path("rig.yaml"));
    }
    static void TearDownTestSuite()
    {
        delete folder_;
        folder_ = nullptr;
    }
    static void write(const std::string& name, const std::string& text) { std::ofstream(folder_->path(name)) << text; }
    /// A configuration whose [cameras] also hold `more`; the words that name it.
    static std::string config(const std::string& more = "", const std::string& sections = "")
    {
        write("dicot.toml", "[cameras]\nleft = \"replay:pairs\"\nright = \"replay:pairs\"\n" + more +
                                "\n[rig]\nfile = \"rig.yaml\"\n" + sections);
        return " --config " + folder_->path("dicot.toml") + " ";
    }

    static test::TempFolder* folder_;
};
test::TempFolder* Recorded::folder_ = nullptr;

TEST_F(Recorded, WithoutCameraAndConfigurationAPairIsDrawnAndSaidToBe)
{
    if (!app::no_camera_is_there() || fs::exists(app::kDefaultConfigFile))
        GTEST_SKIP() << "this computer has cameras, or a configuration: nothing is drawn";
    const ToolRun run = dicot("snap --raw --json -o " + folder_->path("first"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const json record = json_in(run.output);
    EXPECT_EQ(record["source"], "drawn pictures");
    EXPECT_EQ(record["outcome"], "done");
    EXPECT_GT(record["cloud"]["points"].get<int>(), 50'000);
    const fs::path shot = record["folder"].get<std::string>();
    EXPECT_THAT(names_in(shot),
                ElementsAre("SHA256SUMS", "cloud.drc", "left.jpg", "raw_left.png", "raw_right.png", "record.json"));
}

TEST_F(Recorded, TheCloudOfASnapshotIsThatOfTheFiles)
{
    const ToolRun snap =
        dicot("snap --json" + config("", "[output]\ndevice = 'bench-3'\n") + "-o " + folder_->path("same"));
    ASSERT_EQ(snap.exit_code, 0) << snap.output;
    const json record = json_in(snap.output);
    const ToolRun process =
        dicot("process " + folder_->path("pairs/left01.png") + " " + folder_->path("pairs/right01.png") + " --rig " +
              folder_->path("rig.yaml") + " -o " + folder_->path("files.drc"));
    ASSERT_EQ(process.exit_code, 0) << process.output;
    const auto stored = app::CloudOnDisk::read((record["folder"].get<std::string>() + "/cloud.drc").c_str());
    const auto files = app::CloudOnDisk::read(folder_->path("files.drc").c_str());
    ASSERT_TRUE(stored.ok() && files.ok()) << stored.status().message();
    EXPECT_TRUE(same_points(stored.value().cloud(), files.value().cloud()));
    const CloudMeta& meta = stored.value().meta();
    EXPECT_EQ(meta.sequence, 1);
    EXPECT_EQ(meta.device_id.view(), "bench-3");
    EXPECT_EQ(meta.clock_trust.view(), record["clock"]["trust"].get<std::string>());
    EXPECT_EQ(meta.captured_at.view(), record["shot"]["time"].get<std::string>());
    EXPECT_TRUE(is_utc_time(meta.captured_at.view()));
    EXPECT_EQ(meta.skew_us, record["shot"]["skew_us"].get<std::int64_t>());
    EXPECT_FALSE(files.value().meta().sequence);
    EXPECT_EQ(record["source"], "recorded pictures");
    EXPECT_EQ(record["shot"]["views"]["order"], "as named");
    EXPECT_EQ(record["shot"]["pairs_used"], 8);
    EXPECT_EQ(record["cameras"]["left"]["warm_up"]["state"], "settled");
    EXPECT_EQ(json_file(record["folder"].get<std::string>() + "/record.json")["cloud"]["points"],
              record["cloud"]["points"]);
}

TEST_F(Recorded, CamerasThatAreSwappedAreNamed)
{
    fs::create_directory(folder_->path("swapped"));
    fs::copy(folder_->path("pairs/left01.png"), folder_->path("swapped/right01.png"));
    fs::copy(folder_->path("pairs/right01.png"), folder_->path("swapped/left01.png"));
    write("swapped.toml", "[cameras]\nleft = \"replay:swapped\"\nright = \"replay:swapped\"\n");
    const ToolRun run = dicot("capture --config " + folder_->path("swapped.toml") + " -o " + folder_->path("turned"));
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("the left and the right camera seem to be swapped"));
    EXPECT_EQ(json_file(folder_->path("turned/record.json"))["pairs"][0]["views"]["order"], "swapped");
}

TEST_F(Recorded, SeveralPairsAreNumberedAndNeverWrittenOver)
{
    const std::string words = "capture --pairs 3" + config() + "-o " + folder_->path("three");
    const ToolRun run = dicot(words);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    for (const char* name : {"left001.png", "right001.png", "left003.png", "right003.png"})
        EXPECT_EQ(
            bytes_of(folder_->path(std::string("three/") + name)).size(),
            bytes_of(folder_->path("three/" + std::string(name).substr(0, std::string(name).find('0')) + "002.png"))
                .size())
            << name;
    const json record = json_file(folder_->path("three/record.json"));
    EXPECT_EQ(record["pairs"].size(), 3U);
    EXPECT_EQ(record["pairs"][2]["left"], "left003.png");
    const ToolRun again = dicot(words);
    EXPECT_EQ(again.exit_code, 73);
    EXPECT_THAT(again.output, HasSubstr("record.json is there already"));
}

struct Miss
{
    const char* script;
    const char* reason;
};

TEST_F(Recorded, AMissIsRecordedWithItsReason)
{
    int number = 0;
    for (const Miss& miss :
         {Miss{"hang 30", "given up after 2 restarts, 2 reopens and 1 port resets"},
          Miss{"gone 3", "is gone; check its plug and cable"},
          Miss{"skew_us 12000", "8 began more than 10000 us apart"}, Miss{"full 100", "no bandwidth left"}}) {
        const std::string out = folder_->path("miss" + std::to_string(number++));
        const ToolRun run =
            dicot("snap" + config(std::string("replay_script_right = \"") + miss.script + "\"") + "-o " + out);
        EXPECT_EQ(run.exit_code, 69) << miss.script << run.output;
        EXPECT_THAT(run.output, HasSubstr(miss.reason));
        ASSERT_EQ(snapshots_in(out).size(), 1U) << miss.script;
        const fs::path shot = snapshots_in(out).front();
        const json record = json_file(shot / "record.json");
        EXPECT_EQ(record["outcome"], "missed");
        EXPECT_THAT(record["reason"].get<std::string>(), HasSubstr(miss.reason));
        EXPECT_THAT(names_in(shot), ElementsAre("SHA256SUMS", "record.json"));
    }
}

TEST_F(Recorded, ACameraThatDiesLateLeavesASnapshotWithAWarning)
{
    const ToolRun run =
        dicot("snap --json" + config("replay_script_right = \"hang 50\"") + "-o " + folder_->path("late"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_LT(json_in(run.output)["shot"]["pairs_used"].get<int>(), 8);
    EXPECT_THAT(run.output, HasSubstr("the right camera stopped and did not come back"));
}

TEST_F(Recorded, ARecordOfAMissMayBeReplacedByPictures)
{
    const std::string out = "-o " + folder_->path("again");
    EXPECT_EQ(dicot("capture" + config("replay_script_right = \"hang 30\"") + out).exit_code, 69);
    EXPECT_EQ(json_file(folder_->path("again/record.json"))["outcome"], "missed");
    const ToolRun run = dicot("capture" + config() + out);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_EQ(json_file(folder_->path("again/record.json"))["outcome"], "done");
}

TEST_F(Recorded, NamesThatAreNoTextAreNoReasonToStop)
{
    const ToolRun run = dicot("snap --json" + config() + "-o '" + folder_->path("x\xFF") + "'");
    EXPECT_EQ(run.exit_code, 0) << run.output;
}

TEST_F(Recorded, SnapshotsOfOneMomentWaitForEachOther)
{
    const std::string words =
        std::string{DICOT_PROGRAM} + " snap" + config() + "-o " + folder_->path("together") + " >/dev/null & ";
    EXPECT_EQ(test::run(words + words + words + "wait").exit_code, 0);
    const std::vector<fs::path> shots = snapshots_in(folder_->path("together"));
    ASSERT_EQ(shots.size(), 3U);
    for (std::size_t i = 0; i < shots.size(); ++i) {
        EXPECT_EQ(json_file(shots[i] / "record.json")["sequence"], i + 1);
        EXPECT_TRUE(fs::exists(shots[i] / "cloud.drc"));
    }
}

TEST_F(Recorded, AnInterruptIsAMissWithoutPictures)
{
    const std::string out = folder_->path("interrupted");
    const std::string snap =
        std::string{DICOT_PROGRAM} + " snap" +
        config("replay_script = \"dark 500\"", "[exposure]\nwarm_up_s = 120\n[burst]\nframes = 64\n") + "-o " + out;
    // As soon as it has its number; the capture goes on for hundreds of frames then.
    const ToolRun run = test::run("{ " + snap + " & }; until ls -d " + out +
                                  "/*/incoming/0* >/dev/null; do kill -0 $! || break; done; kill -TERM $!; wait $!");
    EXPECT_EQ(run.exit_code, 75) << run.output;
    ASSERT_EQ(snapshots_in(out).size(), 1U);
    EXPECT_THAT(names_in(snapshots_in(out).front()), ElementsAre("SHA256SUMS", "record.json"));
    EXPECT_EQ(json_file(snapshots_in(out).front() / "record.json")["outcome"], "missed");
}

TEST_F(Recorded, ACameraThatRecoversMakesASnapshotThatSaysSo)
{
    const ToolRun run =
        dicot("snap --json" + config("replay_script_left = \"hang 30 port\"") + "-o " + folder_->path("shaken"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const json ladder = json_in(run.output)["cameras"]["left"]["ladder"];
    EXPECT_EQ(ladder["recoveries"], 1);
    EXPECT_EQ(ladder["port_resets"], 1);
}

TEST_F(Recorded, WhatWasNeverTriedLeavesNothing)
{
    const ToolRun wrong = dicot("snap" + config("replay_script = \"explode 3\"") + "-o " + folder_->path("nothing"));
    EXPECT_EQ(wrong.exit_code, 78) << wrong.output;
    EXPECT_THAT(wrong.output, HasSubstr("explode 3"));
    EXPECT_FALSE(fs::exists(folder_->path("nothing")));
    std::string rig = test::run("cat " + folder_->path("rig.yaml")).output;
    rig.erase(rig.find("near_mm"), rig.find("P1:") - rig.find("near_mm"));
    write("norange.yaml", rig);
    const char* const cameras = "[cameras]\nleft = \"replay:pairs\"\nright = \"replay:pairs\"\n[rig]\nfile = ";
    write("norange.toml", cameras + std::string("\"norange.yaml\"\n"));
    const ToolRun no_range =
        dicot("snap --config " + folder_->path("norange.toml") + " -o " + folder_->path("nothing"));
    EXPECT_EQ(no_range.exit_code, 64) << no_range.output;
    EXPECT_FALSE(fs::exists(folder_->path("nothing")));
}

} // namespace
} // namespace dicot
