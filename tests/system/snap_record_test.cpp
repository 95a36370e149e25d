// What dicot snap keeps of a slot: all that is known, and of a miss why.
#include "store_commands.h"

#include "dicot/base/utc_time.h"

#include <gmock/gmock.h>

namespace dicot {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ToolRun;
using testing::AllOf;
using testing::HasSubstr;

class SnapRecord : public test::StoreOfOneBoard
{
protected:
    static void write_config(const std::string& name, const std::string& rig, const std::string& more)
    {
        std::ofstream(folder_->path(name))
            << "[cameras]\nleft = 'replay:pairs'\nright = 'replay:pairs'\n[rig]\nfile = '" << rig
            << "'\n[output]\ndevice = 'bench'\n"
            << more;
    }
};

TEST_F(SnapRecord, TheRecordHoldsWhatIsKnown)
{
    const std::string sections = "keep_raw = true\n[matching]\nwindow = 5\n[burst]\nframes = 2\n";
    write_config("known.toml", "rig.yaml", sections);
    const ToolRun run = dicot("snap -o " + own_.path("known") + " --config " + folder_->path("known.toml"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const fs::path shot = snapshots(own_.path("known")).front();
    const json record = json::parse(test::text_of(shot / "record.json"));
    EXPECT_EQ(record["format"], "dicot record 1");
    EXPECT_EQ(record["sequence"], 1);
    EXPECT_EQ(record["device"], "bench");
    EXPECT_TRUE(record["due"].is_null());
    EXPECT_TRUE(record["reason"].is_null());
    EXPECT_TRUE(is_utc_time(record["time"].get<std::string>()));
    EXPECT_THAT(record["clock"]["trust"].get<std::string>(), testing::AnyOf("synchronised", "set"));
    EXPECT_EQ(record["parameters"]["matching"]["window"], 5);
    EXPECT_EQ(record["parameters"]["output"]["keep_raw"], true);
    EXPECT_GT(record["memory"]["arena_bytes"], 1'000'000);
    EXPECT_GT(record["memory"]["peak_resident_bytes"], 1'000'000);
    EXPECT_EQ(record["store"]["interrupted"], 0);
    EXPECT_TRUE(record["temperatures_c"].is_object());
    std::size_t bytes = 0;
    for (const fs::directory_entry& file : fs::directory_iterator(shot)) {
        const std::string name = file.path().filename().string();
        if (name == "record.json" || name == "SHA256SUMS")
            continue;
        bytes += file.file_size();
        EXPECT_THAT(test::run("sha256sum " + file.path().string()).output,
                    testing::StartsWith(record["digests"].value(name, "none")))
            << name;
    }
    EXPECT_EQ(record["digests"].size(), 4U);
    EXPECT_EQ(record["bytes_written"], bytes);
    EXPECT_EQ(test::run("cd " + shot.string() + " && sha256sum --strict -c SHA256SUMS").exit_code, 0);
}

TEST_F(SnapRecord, ARigFileThatIsNotThereIsAMiss)
{
    write_config("norig.toml", "none.yaml", "");
    const ToolRun no_rig = dicot("snap --config " + folder_->path("norig.toml") + " -o " + own_.path("norig"));
    EXPECT_EQ(no_rig.exit_code, 66);
    EXPECT_THAT(no_rig.output, HasSubstr("none.yaml"));
    ASSERT_EQ(snapshots(own_.path("norig")).size(), 1U);
    const json record = json::parse(test::text_of(snapshots(own_.path("norig")).front() / "record.json"));
    EXPECT_THAT(record["reason"].get<std::string>(), HasSubstr("none.yaml"));
}

TEST_F(SnapRecord, ACardWithoutRoomIsAMissWithFiguresAndRemedy)
{
    const std::string root = copy();
    const ToolRun run = snap(root, "", "reserve_mib = 1048576\n");
    EXPECT_EQ(run.exit_code, 74);
    EXPECT_THAT(run.output, AllOf(HasSubstr("the card is full"), HasSubstr("output.reserve_mib")));
    const json slots = report("list --missed", root)["stores"][0]["slots"];
    ASSERT_EQ(slots.size(), 2U);
    EXPECT_THAT(slots[1]["reason"].get<std::string>(), HasSubstr("the card is full"));
    EXPECT_THAT(dicot("list --store " + root + config("", "reserve_mib = 1048576\n")).output,
                testing::ContainsRegex("(room for 0.0 days|not known yet)"));
}

TEST_F(SnapRecord, AFileThatCannotBeWrittenIsAMissWithoutPictures)
{
    const std::string root = copy();
    // No file may be larger than 100 KiB: the cloud is.
    const ToolRun run =
        test::run("trap '' XFSZ; ulimit -f 200; " + std::string{DICOT_PROGRAM} + " snap -o " + root + config());
    EXPECT_EQ(run.exit_code, 74) << run.output;
    EXPECT_THAT(run.output, HasSubstr("cloud.drc: "));
    const fs::path missed = snapshots(root).back();
    EXPECT_FALSE(fs::exists(missed / "left.jpg"));
    const json record = json::parse(test::text_of(missed / "record.json"));
    EXPECT_EQ(record["sequence"], 4);
    EXPECT_EQ(record["outcome"], "missed");
    EXPECT_FALSE(record.contains("cloud"));
    EXPECT_TRUE(record.contains("shot"));
    EXPECT_EQ(ask("verify", root).exit_code, 0);
}

TEST_F(SnapRecord, AReasonTooLongForItsRowIsTheSameInRecordAndRow)
{
    const std::string root = copy();
    std::string name;
    for (int i = 0; i < 90; ++i)
        name += i % 7 == 0 ? "x" : "ü";
    std::ofstream(folder_->path("long.toml")) << "[cameras]\nleft = 'replay:" << name << "'\nright = 'replay:" << name
                                              << "'\n[rig]\nfile = 'rig.yaml'\n[output]\ndevice = 'bench'\n";
    const ToolRun run = dicot("snap -o " + root + " --config " + folder_->path("long.toml"));
    EXPECT_NE(run.exit_code, 0);
    EXPECT_THAT(run.output, HasSubstr("the miss is recorded in"));
    const ToolRun verified = ask("verify", root);
    EXPECT_EQ(verified.exit_code, 0) << verified.output;
}

TEST_F(SnapRecord, TheFolderOfOneBoardIsNotWhereBoardsGo)
{
    const std::string root = copy();
    const ToolRun run = snap(root + "/bench");
    EXPECT_EQ(run.exit_code, 64);
    EXPECT_THAT(run.output, HasSubstr("name the one around it"));
    EXPECT_FALSE(fs::exists(root + "/bench/bench"));
}

} // namespace
} // namespace dicot
