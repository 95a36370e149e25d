// dicot pull --from and dicot archive, as a person uses them.
#include "../storage/scripted_source.h"
#include "store_commands.h"

#include <gmock/gmock.h>

#include <chrono>
#include <thread>

using namespace dicot::test;
using testing::HasSubstr;

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kNoon = 1'780'315'200'000'000; ///< 2026-06-01T12:00:00Z

class Pull : public StoreOfOneBoard
{
protected:
    std::string archive() const { return own_.path("archive"); }
    ToolRun pull(const std::string& from, const std::string& more = "") const
    {
        return dicot("pull '" + archive() + "' --from '" + from + "' " + more);
    }
    nlohmann::json pull_json(const std::string& from, const std::string& more = "") const
    {
        const ToolRun told = run("{ " + std::string{DICOT_PROGRAM} + " pull '" + archive() + "' --json --from '" +
                                 from + "' " + more + " 2>/dev/null; }");
        const nlohmann::json parsed = nlohmann::json::parse(told.output, nullptr, false);
        EXPECT_TRUE(parsed.is_object()) << told.output;
        return parsed.is_object() ? parsed["boards"] : parsed;
    }
    nlohmann::json archive_json(const std::string& command) const
    {
        const ToolRun told = run("{ " + std::string{DICOT_PROGRAM} + " archive " + command + " --json '" + archive() +
                                 "' 2>/dev/null; }");
        const nlohmann::json parsed = nlohmann::json::parse(told.output, nullptr, false);
        EXPECT_TRUE(parsed.is_object()) << told.output;
        return parsed.is_object() ? parsed["boards"][0] : parsed;
    }
    /// Every snapshot of the store is in the archive, byte by byte; sha256sum(1) agrees.
    void expect_whole(const std::string& store) const
    {
        for (const fs::path& folder : snapshots(store)) {
            const fs::path there =
                archive() + "/bench/" + folder.parent_path().filename().string() + "/" + folder.filename().string();
            for (const auto& entry : fs::directory_iterator(folder))
                EXPECT_EQ(text_of(entry.path()), text_of(there / entry.path().filename())) << there;
            EXPECT_EQ(run("cd '" + there.string() + "' && sha256sum --strict -c SHA256SUMS").exit_code, 0);
        }
    }
    /// Folders as a board leaves them, of so many bytes each.
    static void write_store(const fs::path& board, int snapshots, std::size_t bytes)
    {
        for (int k = 1; k <= snapshots; ++k) {
            const std::int64_t began_us = kNoon + k * std::int64_t{3'600'000'000};
            char name[64];
            std::snprintf(name, sizeof name, "%06d_%s", k, dicot::utc_stamp(began_us).c_str());
            const fs::path folder = board / dicot::utc_day(began_us).c_str() / name;
            fs::create_directories(folder);
            for (const auto& [file, content] : honest(k, began_us, bytes).files)
                std::ofstream(folder / file, std::ios::binary) << content;
        }
    }
};

TEST_F(Pull, takes_a_store_into_an_archive_and_knows_what_is_there)
{
    const std::string store = folder_->path("first");
    const ToolRun first = pull(store);
    EXPECT_EQ(first.exit_code, 0) << first.output;
    EXPECT_THAT(first.output, HasSubstr("bench"));
    expect_whole(store);
    const nlohmann::json second = pull_json(store);
    ASSERT_EQ(second.size(), 1U);
    EXPECT_EQ(second[0]["new"], 0);
    EXPECT_EQ(second[0]["there"], 3);
    const nlohmann::json status = archive_json("status");
    EXPECT_EQ(status["snapshots"], 3);
    EXPECT_EQ(status["missed"], 1);
    EXPECT_EQ(status["missed_by_reason"].size(), 1U);
    EXPECT_EQ(status["newest"]["sequence"], 3);
    EXPECT_TRUE(status["waiting"].empty());
    EXPECT_TRUE(status["lost"].empty());
    EXPECT_TRUE(status["last_pull"].is_string());
    EXPECT_EQ(dicot("archive check '" + archive() + "'").exit_code, 0);
}

TEST_F(Pull, takes_what_is_called_a_card_a_copy_and_an_archive)
{
    const std::string store = folder_->path("first");
    const std::string bare = own_.path("bare"); // copied by hand, without catalogue and under another name
    fs::create_directories(bare);
    for (const auto& entry : fs::directory_iterator(store + "/bench"))
        if (entry.is_directory() && entry.path().filename().string().starts_with("20"))
            fs::copy(entry.path(), bare + "/" + entry.path().filename().string(), fs::copy_options::recursive);
    const std::string card = own_.path("card");
    fs::create_directories(card + "/var/lib/dicot");
    fs::copy(store, card + "/var/lib/dicot/clouds", fs::copy_options::recursive);
    for (const std::string& from : {store, store + "/bench", store + "/bench/", bare, card}) {
        fs::remove_all(archive());
        const nlohmann::json boards = pull_json(from);
        ASSERT_EQ(boards.size(), 1U) << from;
        EXPECT_EQ(boards[0]["device"], "bench") << from;
        EXPECT_EQ(boards[0]["new"], 3) << from;
        expect_whole(store);
    }
    const std::string once_more = own_.path("other");
    EXPECT_EQ(dicot("pull " + once_more + " --from '" + archive() + "'").exit_code, 0);
    EXPECT_EQ(run("cd '" + archive() + "/bench' && find . -path './20*' -type f | sort | xargs sha256sum").output,
              run("cd '" + once_more + "/bench' && find . -path './20*' -type f | sort | xargs sha256sum").output);
}

TEST_F(Pull, writes_nothing_to_its_source)
{
    const std::string store = copy();
    ASSERT_EQ(run("chmod -R a-w '" + store + "'").exit_code, 0);
    const std::string look = "cd '" + store + "' && find . | sort | xargs stat -c '%n %Y %s'";
    const std::string before = run(look).output;
    EXPECT_EQ(pull(store, "--verify --all --set-clock").exit_code, 0);
    EXPECT_EQ(run(look).output, before);
    (void)run("chmod -R u+w '" + store + "'");
}

TEST_F(Pull, leaves_what_another_computer_has_and_takes_it_with_all)
{
    const std::string store = copy();
    const fs::path one = snapshots(store)[0];
    const std::string line = "2026-06-02T08:00:00Z " + sha256_text(text_of(one / "SHA256SUMS"));
    std::ofstream(one / "PULLED") << line
                                  << run("printf '%s' '" + line +
                                         "' | gzip -c | tail -c 8 | head -c 4 | od -An "
                                         "-tx4 --endian=little | tr '\\n' ' ' | sed 's/ $//'")
                                         .output
                                  << "\n";
    nlohmann::json boards = pull_json(store);
    EXPECT_EQ(boards[0]["new"], 2);
    EXPECT_EQ(boards[0]["left_elsewhere"], 1);
    EXPECT_EQ(archive_json("status")["waiting"], nlohmann::json::parse("[[1, 1]]"));
    boards = pull_json(store, "--all");
    EXPECT_EQ(boards[0]["new"], 1);
    EXPECT_FALSE(fs::exists(archive() + "/bench/" + one.parent_path().filename().string() + "/" +
                            one.filename().string() + "/PULLED"));
}

TEST_F(Pull, names_what_is_damaged_and_takes_the_rest)
{
    const std::string store = copy();
    flip_a_bit(snapshots(store)[0] / "cloud.drc", 100);
    const ToolRun run = pull(store);
    EXPECT_EQ(run.exit_code, 65) << run.output;
    EXPECT_THAT(run.output, HasSubstr("snapshot 1: cloud.drc"));
    EXPECT_EQ(snapshots(archive()).size(), 2U);
    EXPECT_TRUE(fs::is_empty(archive() + "/bench/incoming"));
    fs::remove_all(snapshots(store)[0]);
    EXPECT_EQ(pull(store).exit_code, 0);
    EXPECT_EQ(archive_json("status")["waiting"], nlohmann::json::parse("[[1, 1]]"));
}

TEST_F(Pull, mends_a_damaged_archive_when_it_shall_verify)
{
    const std::string store = folder_->path("first");
    ASSERT_EQ(pull(store).exit_code, 0);
    flip_a_bit(snapshots(archive())[0] / "left.jpg", 50);
    const ToolRun check = dicot("archive check '" + archive() + "'");
    EXPECT_EQ(check.exit_code, 65) << check.output;
    EXPECT_THAT(check.output, HasSubstr("left.jpg"));
    EXPECT_EQ(archive_json("check")["damaged"], 1);
    EXPECT_EQ(pull(store).exit_code, 0);
    const nlohmann::json mended = pull_json(store, "--verify");
    EXPECT_EQ(mended[0]["put_aside"], 1);
    EXPECT_EQ(mended[0]["new"], 1);
    expect_whole(store);
    EXPECT_EQ(archive_json("check")["damaged"], 0);
    EXPECT_EQ(archive_json("status")["in_quarantine"], 1);
}

TEST_F(Pull, has_its_archive_left_alone_by_those_who_write_stores)
{
    ASSERT_EQ(pull(folder_->path("first")).exit_code, 0);
    for (const char* const gone : {"", "/bench/LAST_PULL"}) { // a first pull that was killed has only its mark
        if (gone[0] != '\0')
            fs::remove(archive() + gone);
        const std::string look = "cd '" + archive() + "' && find . | sort | xargs stat -c '%n %s'";
        const std::string before = run(look).output;
        for (const ToolRun& told :
             {ask("prune", archive(), "--older-than 1"), ask("verify", archive(), "--repair"), snap(archive())}) {
            EXPECT_EQ(told.exit_code, 64) << told.output;
            EXPECT_THAT(told.output, HasSubstr("dicot archive"));
        }
        for (const ToolRun& told : {ask("list", archive()), ask("verify", archive()), ask("show", archive(), "1")})
            EXPECT_EQ(told.exit_code, 0) << told.output;
        EXPECT_EQ(run(look).output, before);
    }
    EXPECT_EQ(pull(folder_->path("first")).exit_code, 0);
}

TEST_F(Pull, says_in_a_sentence_what_cannot_be)
{
    EXPECT_EQ(pull(own_.path("nowhere")).exit_code, 66);
    fs::create_directories(own_.path("empty"));
    EXPECT_EQ(pull(own_.path("empty")).exit_code, 66);
    const std::string store = copy();
    EXPECT_EQ(pull(store, "--device nobody").exit_code, 66);
    EXPECT_EQ(pull(store, "--since yesterday").exit_code, 64);
    const ToolRun into_itself = dicot("pull '" + store + "' --from '" + folder_->path("first") + "'");
    EXPECT_EQ(into_itself.exit_code, 64) << into_itself.output;
    EXPECT_THAT(into_itself.output, HasSubstr("store"));
    EXPECT_EQ(dicot("pull '" + store + "/bench' --from '" + folder_->path("first") + "'").exit_code, 64);
    EXPECT_EQ(dicot("archive status '" + own_.path("nowhere") + "'").exit_code, 66);
    EXPECT_EQ(dicot("archive check '" + own_.path("nowhere") + "'").exit_code, 66);
    EXPECT_EQ(run("env -u HOME " DICOT_PROGRAM " archive status").exit_code, 64);
}

TEST_F(Pull, has_a_disk_that_is_full_named_and_goes_on_when_there_is_room)
{
    const fs::path store = own_.path("store");
    write_store(store / "bench", 6, 300'000);
    // A limit of the file's size stands for the disk's end, of which no file system of a test's own is needed.
    const ToolRun full =
        run("sh -c 'ulimit -f 200; exec " DICOT_PROGRAM " pull " + archive() + " --from " + store.string() + "'");
    EXPECT_EQ(full.exit_code, 74) << full.output;
    EXPECT_TRUE(snapshots(archive() + "/bench").size() == 0 ||
                fs::exists(archive() + "/bench/incoming/000001_20260601T130000Z"));
    EXPECT_EQ(pull(store).exit_code, 0);
    expect_whole(store);
}

TEST_F(Pull, goes_on_wherever_it_was_killed)
{
    const fs::path store = own_.path("store");
    write_store(store / "bench", 8, 1'000'000);
    int killed = 0;
    int exit_code = -1;
    for (int k = 0; k < 40 && exit_code != 0; ++k) {
        char patience[32];
        std::snprintf(patience, sizeof patience, "0.%03d", 20 + (k * 37) % 60);
        exit_code = run("timeout -s KILL " + std::string{patience} + " " DICOT_PROGRAM " pull " + archive() +
                        " --from " + store.string())
                        .exit_code;
        killed += exit_code == 137 ? 1 : 0;
        ASSERT_TRUE(exit_code == 0 || exit_code == 137) << exit_code;
        if (fs::exists(archive())) {
            EXPECT_EQ(dicot("archive check '" + archive() + "'").exit_code, 0);
        }
    }
    EXPECT_GT(killed, 0) << "it was never interrupted";
    EXPECT_EQ(pull(store).exit_code, 0);
    expect_whole(store);
    EXPECT_TRUE(fs::is_empty(archive() + "/bench/incoming"));
}

TEST_F(Pull, ends_cleanly_when_somebody_wants_it_to)
{
    const fs::path store = own_.path("store");
    write_store(store / "bench", 20, 2'000'000);
    const std::string words = "'" + archive() + "' --from " + store.string();
    const ToolRun stopped = run("{ " DICOT_PROGRAM " pull " + words + " & while [ ! -d '" + archive() +
                                "/bench/incoming' ]; do sleep 0.01; done; kill -TERM $!; wait $!; echo code $?; }");
    EXPECT_THAT(stopped.output, HasSubstr("code 75"));
    EXPECT_THAT(stopped.output, HasSubstr("stopped"));
    EXPECT_LT(snapshots(archive() + "/bench").size(), 20U);
    EXPECT_EQ(dicot("archive check '" + archive() + "'").exit_code, 0);
    EXPECT_EQ(pull(store).exit_code, 0);
    expect_whole(store);
}

TEST_F(Pull, takes_two_boards_at_once_and_refuses_to_write_beside_another_pull)
{
    const fs::path store = own_.path("store");
    write_store(store / "bench", 4, 100'000);
    write_store(store / "tent-2", 5, 100'000);
    nlohmann::json boards = pull_json(store);
    ASSERT_EQ(boards.size(), 2U);
    EXPECT_EQ(boards[0]["new"], 4);
    EXPECT_EQ(boards[1]["new"], 5);
    const ToolRun beside =
        run("flock '" + archive() + "/bench' " DICOT_PROGRAM " pull '" + archive() + "' --from " + store.string());
    EXPECT_EQ(beside.exit_code, 75) << beside.output;
    EXPECT_THAT(beside.output, HasSubstr("another pull"));
}

} // namespace
