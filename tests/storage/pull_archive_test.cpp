// The archive against sources that lie, fail and vanish.
#include "crash_medium.h"
#include "pull_scene.h"

using namespace dicot;
using namespace dicot::test;

namespace {

class PullArchive : public ::testing::Test
{
protected:
    PullArchive() { source_.all.push_back(honest(1, kNoon, 1000)); }

    Took took(bool verify = false)
    {
        const Result<Taken> taken = take_first(medium_, source_, verify);
        EXPECT_TRUE(taken.ok()) << taken.status().message();
        if (taken.ok())
            last_why_ = taken.value().why.message();
        return taken.ok() ? taken.value().how : Took::kUnreadable;
    }
    /// The files of the first snapshot become these, told by a source that tells no digests.
    void offer(Files files)
    {
        source_.all.front().files = std::move(files);
        source_.all.front().offer.sums.reset();
    }
    const ScriptedSnapshot& first() const { return source_.all.front(); }

    CrashMedium medium_;
    ScriptedSource source_;
    std::string last_why_;
};

TEST_F(PullArchive, holds_what_the_source_has_byte_by_byte)
{
    EXPECT_EQ(took(), Took::kNew);
    EXPECT_TRUE(is_whole_copy(medium_, kFirstFolder, first()));
    EXPECT_TRUE(names_in(medium_, "incoming").empty());
    EXPECT_EQ(took(), Took::kThere);
    EXPECT_EQ(source_.bytes_read["cloud.drc"], 1000U) << "what is there is not read again";
}

TEST_F(PullArchive, holds_all_or_nothing_wherever_the_cable_is_pulled_and_reads_nothing_twice)
{
    (void)took();
    const std::uint64_t all_reads = source_.reads;
    ASSERT_GT(all_reads, 18U);
    const std::uint64_t pieces_of_the_cloud = (1000 + 63) / 64;
    for (std::uint64_t cut = 0; cut < all_reads; ++cut) {
        CrashMedium medium;
        ScriptedSource source;
        source.all = source_.all;
        source.reads_left = cut;
        const Result<Taken> broken = take_first(medium, source);
        ASSERT_EQ(broken.status().fault(), Fault::kUnavailable) << "cut at read " << cut;
        EXPECT_FALSE(is_there(medium, kFirstFolder)) << "cut at read " << cut;
        source.reads_left = std::numeric_limits<std::uint64_t>::max();
        const Result<Taken> resumed = take_first(medium, source);
        ASSERT_TRUE(resumed.ok());
        EXPECT_EQ(resumed.value().how, Took::kNew);
        EXPECT_TRUE(is_whole_copy(medium, kFirstFolder, first())) << "cut at read " << cut;
        EXPECT_EQ(source.bytes_read["cloud.drc"], 1000U) << "cut at read " << cut << " of " << pieces_of_the_cloud;
        EXPECT_EQ(source.bytes_read["record.json"], first().files[1].second.size()) << "cut at read " << cut;
    }
}

TEST_F(PullArchive, begins_a_file_anew_once_if_what_was_left_of_it_is_wrong)
{
    source_.reads_left = 20;
    EXPECT_EQ(take_first(medium_, source_).status().fault(), Fault::kUnavailable);
    const std::string part = std::string{kFirstPart} + "/cloud.drc";
    const int node = medium_.find_file(part.c_str());
    ASSERT_GE(node, 0);
    const std::uint64_t there = medium_.size_of(node);
    ASSERT_GT(there, 0U);
    const std::string zeros(static_cast<std::size_t>(there), '\0');
    ASSERT_TRUE(medium_.write_at(node, 0, std::as_bytes(std::span(zeros))).ok());
    source_.reads_left = std::numeric_limits<std::uint64_t>::max();
    EXPECT_EQ(took(), Took::kNew);
    EXPECT_TRUE(is_whole_copy(medium_, kFirstFolder, first()));
    EXPECT_EQ(source_.bytes_read["cloud.drc"], 1000U + 1000U) << "the rest, and then all of it";
}

TEST_F(PullArchive, calls_damaged_what_is_wrong_twice_and_keeps_nothing_of_it)
{
    source_.all.front().files[0].second[500] ^= 1;
    EXPECT_EQ(took(), Took::kDamaged);
    EXPECT_NE(last_why_.find("cloud.drc"), std::string::npos) << last_why_;
    EXPECT_EQ(source_.bytes_read["cloud.drc"], 2000U);
    EXPECT_FALSE(is_there(medium_, kFirstFolder));
    EXPECT_TRUE(names_in(medium_, "incoming").empty());
}

TEST_F(PullArchive, takes_no_more_than_the_size_that_was_told)
{
    source_.sizes["cloud.drc"] = 10;
    EXPECT_EQ(took(), Took::kDamaged);
    EXPECT_LE(source_.bytes_read["cloud.drc"], 20U);
}

TEST_F(PullArchive, does_not_wait_for_bytes_that_never_come)
{
    source_.sizes["cloud.drc"] = 5000;
    EXPECT_EQ(took(), Took::kDamaged);
    EXPECT_NE(last_why_.find("too early"), std::string::npos) << last_why_;
}

TEST_F(PullArchive, refuses_sizes_that_no_file_has)
{
    source_.sizes["cloud.drc"] = std::uint64_t{1} << 32U;
    EXPECT_EQ(took(), Took::kDamaged);
    source_.sizes = {{"SHA256SUMS", 1'000'000}};
    EXPECT_EQ(took(), Took::kDamaged);
    EXPECT_TRUE(source_.bytes_read.empty() || source_.bytes_read["cloud.drc"] == 0U);
}

TEST_F(PullArchive, says_with_figures_that_the_disk_has_no_room_before_it_begins)
{
    source_.sizes["cloud.drc"] = std::uint64_t{1} << 30U;
    const Status status = take_first(medium_, source_).status();
    EXPECT_EQ(status.fault(), Fault::kIoError);
    EXPECT_NE(std::string{status.message()}.find("1024.0 MiB"), std::string::npos) << status.message();
    EXPECT_EQ(source_.bytes_read["cloud.drc"], 0U);
}

TEST_F(PullArchive, keeps_what_arrived_when_the_disk_is_full_and_goes_on_there)
{
    source_.all.front() = honest(1, kNoon, 100'000);
    source_.most_at_once = 4096;
    ASSERT_TRUE(BoardArchive::open(medium_, source_.serial()).ok());
    medium_.set_fault({ENOSPC, 12, true});
    EXPECT_EQ(take_first(medium_, source_).status().fault(), Fault::kIoError);
    ASSERT_GT(medium_.struck(), 0);
    EXPECT_FALSE(is_there(medium_, kFirstFolder));
    medium_.set_fault({});
    EXPECT_EQ(took(), Took::kNew);
    EXPECT_LE(source_.bytes_read["cloud.drc"], 100'000U + 4096U) << "the piece that found no room comes again";
}

TEST_F(PullArchive, takes_no_name_that_leads_elsewhere)
{
    const std::string record = record_of(1, kNoon);
    for (const char* const name : {"../cloud.drc", "a/b", ".hidden", "..", "", "a\\b", "sha256sums", "PULLED", "pulled",
                                   "RECORD.JSON", "cloud.", "a name", "x23456789012345678901234567890123"}) {
        offer(with_sums({{name, "leaf"}, {"record.json", record}}));
        EXPECT_EQ(took(), Took::kDamaged) << name;
        EXPECT_EQ(medium_.now().find("cloud.drc"), -1);
        EXPECT_TRUE(names_in(medium_, "incoming").empty()) << name;
    }
}

TEST_F(PullArchive, takes_no_more_files_than_a_store_has)
{
    Files many{{"record.json", record_of(1, kNoon)}};
    for (int k = 0; k < 8; ++k)
        many.emplace_back("f" + std::to_string(k), "leaf");
    offer(with_sums(many));
    EXPECT_EQ(took(), Took::kDamaged);
    for (int k = 0; k < 1000; ++k)
        source_.all.front().files.emplace_back("g" + std::to_string(k), "leaf");
    EXPECT_EQ(took(), Took::kDamaged);
    EXPECT_NE(last_why_.find("more than 64"), std::string::npos) << last_why_;
}

TEST_F(PullArchive, passes_over_files_that_the_digests_do_not_name)
{
    source_.all.front().files.emplace_back("PULLED", "a mark");
    source_.all.front().files.emplace_back("../../evil", "evil");
    EXPECT_EQ(took(), Took::kNew);
    EXPECT_EQ(names_in(medium_, kFirstFolder), (std::vector<std::string>{"SHA256SUMS", "cloud.drc", "record.json"}));
}

TEST_F(PullArchive, refuses_the_record_of_another_number_or_time)
{
    offer(with_sums({{"record.json", record_of(2, kNoon)}}));
    EXPECT_EQ(took(), Took::kDamaged);
    offer(with_sums({{"record.json", record_of(1, kNoon + 1'000'000)}}));
    EXPECT_EQ(took(), Took::kDamaged);
    offer(with_sums({{"record.json", "{}"}}));
    EXPECT_EQ(took(), Took::kDamaged);
    offer(with_sums({{"cloud.drc", "leaf"}}));
    EXPECT_EQ(took(), Took::kDamaged) << "a snapshot without a record";
}

TEST_F(PullArchive, refuses_digests_that_are_not_those_that_were_listed)
{
    (*source_.all.front().offer.sums)[0] ^= std::byte{1};
    EXPECT_EQ(took(), Took::kDamaged);
    EXPECT_EQ(source_.bytes_read["cloud.drc"], 0U);
}

TEST_F(PullArchive, refuses_numbers_and_times_that_make_no_name)
{
    for (const auto& [sequence, began_us] : {std::pair<std::int64_t, std::int64_t>{0, kNoon},
                                             {-1, kNoon},
                                             {1'000'000'000, kNoon},
                                             {1, kNoon + 1},
                                             {1, kLastUtcUs + 1},
                                             {1, std::numeric_limits<std::int64_t>::min()}}) {
        source_.all.front().offer.sequence = sequence;
        source_.all.front().offer.began_us = began_us;
        EXPECT_EQ(took(), Took::kDamaged) << sequence << " at " << began_us;
    }
    EXPECT_EQ(source_.reads, 0U);
}

TEST_F(PullArchive, tells_apart_what_is_gone_and_what_cannot_be_read)
{
    const OfferedSnapshot gone{.sequence = 7, .began_us = kNoon, .bytes = {}, .sums = {}};
    const auto archive = BoardArchive::open(medium_, source_.serial());
    ASSERT_TRUE(archive.ok());
    const Result<Taken> pruned = archive.value()->take(source_, gone, false, goes_on);
    ASSERT_TRUE(pruned.ok());
    EXPECT_EQ(pruned.value().how, Took::kGone);
    source_.reads_left = 5;
    source_.then = Fault::kIoError;
    const Result<Taken> unread = archive.value()->take(source_, first().offer, false, goes_on);
    ASSERT_TRUE(unread.ok());
    EXPECT_EQ(unread.value().how, Took::kUnreadable);
    EXPECT_TRUE(is_there(medium_, kFirstPart)) << "it goes on there";
}

TEST_F(PullArchive, stops_between_two_pieces_and_goes_on_there)
{
    const auto archive = BoardArchive::open(medium_, source_.serial());
    ASSERT_TRUE(archive.ok());
    int pieces = 0;
    const Result<Taken> stopped =
        archive.value()->take(source_, first().offer, false, [&](std::uint64_t) { return ++pieces < 5; });
    EXPECT_EQ(stopped.status().fault(), Fault::kTryAgain);
    const Result<Taken> resumed = archive.value()->take(source_, first().offer, false, goes_on);
    ASSERT_TRUE(resumed.ok());
    EXPECT_EQ(resumed.value().how, Took::kNew);
    EXPECT_EQ(source_.bytes_read["cloud.drc"], 1000U);
}

TEST_F(PullArchive, never_replaces_another_snapshot_of_the_same_number)
{
    EXPECT_EQ(took(), Took::kNew);
    const ScriptedSnapshot mine = first();
    source_.all.front() = honest(1, kNoon, 999);
    EXPECT_EQ(took(), Took::kConflict);
    EXPECT_EQ(took(true), Took::kConflict);
    source_.all.front() = honest(1, kNoon + 60'000'000, 1000);
    EXPECT_EQ(took(), Took::kConflict);
    EXPECT_TRUE(is_whole_copy(medium_, kFirstFolder, mine));
    EXPECT_EQ(names_in(medium_, "2026-06-01").size(), 1U);
}

TEST_F(PullArchive, asks_a_source_that_tells_no_digests_only_when_it_shall_verify)
{
    EXPECT_EQ(took(), Took::kNew);
    offer(honest(1, kNoon, 999).files);
    source_.all.front().offer.pulled = true;
    EXPECT_EQ(took(), Took::kThere);
    EXPECT_EQ(took(true), Took::kConflict);
}

TEST_F(PullArchive, puts_a_damaged_copy_aside_and_takes_it_anew)
{
    EXPECT_EQ(took(), Took::kNew);
    const int node = medium_.find_file((std::string{kFirstFolder} + "/cloud.drc").c_str());
    ASSERT_TRUE(medium_.write_at(node, 7, std::as_bytes(std::span("spoilt", 6))).ok());
    source_.all.front().offer.pulled = true;
    EXPECT_EQ(took(), Took::kThere) << "it is believed";
    const Result<Taken> anew = take_first(medium_, source_, true);
    ASSERT_TRUE(anew.ok());
    EXPECT_EQ(anew.value().how, Took::kNew);
    EXPECT_EQ(anew.value().put_aside, 1);
    EXPECT_TRUE(is_whole_copy(medium_, kFirstFolder, first()));
    EXPECT_EQ(names_in(medium_, "quarantine").size(), 1U);
    ASSERT_TRUE(medium_
                    .write_at(medium_.find_file((std::string{kFirstFolder} + "/SHA256SUMS").c_str()), 3,
                              std::as_bytes(std::span("#", 1)))
                    .ok());
    EXPECT_EQ(took(), Took::kNew) << "digests that cannot be read are believed by nobody";
    EXPECT_EQ(names_in(medium_, "quarantine").size(), 2U);
}

TEST_F(PullArchive, believes_no_copy_of_which_the_source_is_still_to_be_told)
{
    EXPECT_EQ(took(), Took::kNew);
    ASSERT_TRUE(medium_.remove_file((std::string{kFirstFolder} + "/cloud.drc").c_str()).ok());
    EXPECT_EQ(took(), Took::kNew) << "a copy that stopped early";
    EXPECT_TRUE(is_whole_copy(medium_, kFirstFolder, first()));
    EXPECT_EQ(took(), Took::kThere);
}

TEST_F(PullArchive, keeps_a_damaged_copy_in_its_place_until_the_new_one_is_complete)
{
    EXPECT_EQ(took(), Took::kNew);
    source_.all.front().offer.pulled = true;
    const int node = medium_.find_file((std::string{kFirstFolder} + "/cloud.drc").c_str());
    ASSERT_TRUE(medium_.write_at(node, 7, std::as_bytes(std::span("spoilt", 6))).ok());
    for (const std::uint64_t reads : {0U, 1U, 9U}) {
        source_.reads_left = reads;
        EXPECT_EQ(take_first(medium_, source_, true).status().fault(), Fault::kUnavailable);
        EXPECT_TRUE(is_there(medium_, kFirstFolder)) << reads;
        const auto archive = BoardArchive::open(medium_, source_.serial());
        ASSERT_TRUE(archive.ok());
        EXPECT_TRUE(archive.value()->is_owed(1)) << reads;
        NumberRanges had;
        had.add(1);
        EXPECT_TRUE(archive.value()->note({kNoon, had}).ok());
    }
    source_.reads_left = std::numeric_limits<std::uint64_t>::max();
    EXPECT_EQ(took(), Took::kNew) << "without a wish to verify, and although it is marked";
    EXPECT_TRUE(is_whole_copy(medium_, kFirstFolder, first()));
    EXPECT_EQ(names_in(medium_, "quarantine").size(), 1U);
    EXPECT_TRUE(names_in(medium_, "incoming").empty());
    EXPECT_EQ(took(), Took::kThere);
}

TEST_F(PullArchive, owes_what_went_to_quarantine_until_it_is_in_its_place)
{
    EXPECT_EQ(took(), Took::kNew);
    ASSERT_TRUE(medium_.make_folder("quarantine").ok());
    ASSERT_TRUE(medium_.rename(kFirstFolder, "quarantine/000001_20260601T120000Z.2").ok());
    {
        const auto archive = BoardArchive::open(medium_, source_.serial());
        ASSERT_TRUE(archive.ok());
        EXPECT_TRUE(archive.value()->is_owed(1));
    }
    EXPECT_EQ(took(), Took::kNew);
    const auto archive = BoardArchive::open(medium_, source_.serial());
    ASSERT_TRUE(archive.ok());
    EXPECT_FALSE(archive.value()->is_owed(1));
}

TEST_F(PullArchive, keeps_a_half_part_that_a_damaged_copy_cannot_end)
{
    source_.reads_left = 10;
    EXPECT_EQ(take_first(medium_, source_).status().fault(), Fault::kUnavailable);
    ScriptedSource copy;
    copy.serial_number = "";
    copy.all = {first()};
    copy.all.front().files.pop_back(); // SHA256SUMS
    const Result<Taken> taken = take_first(medium_, copy);
    ASSERT_TRUE(taken.ok());
    EXPECT_EQ(taken.value().how, Took::kDamaged);
    source_.reads_left = std::numeric_limits<std::uint64_t>::max();
    EXPECT_EQ(took(), Took::kNew);
    EXPECT_EQ(source_.bytes_read["cloud.drc"], 1000U) << "nothing came twice";
}

TEST_F(PullArchive, is_of_one_board_alone)
{
    EXPECT_EQ(took(), Took::kNew);
    source_.serial_number = "10000000b";
    const Status other = take_first(medium_, source_).status();
    EXPECT_EQ(other.fault(), Fault::kBadData);
    EXPECT_NE(std::string{other.message()}.find("10000000a"), std::string::npos) << other.message();
    EXPECT_NE(std::string{other.message()}.find("output.device"), std::string::npos) << other.message();
    source_.serial_number = ""; // a card
    EXPECT_EQ(took(), Took::kThere);
    source_.serial_number = "line\nbreak";
    CrashMedium empty;
    EXPECT_EQ(take_first(empty, source_).status().fault(), Fault::kBadData);
}

TEST_F(PullArchive, is_no_store_of_a_board)
{
    Medium::File file = 0;
    ASSERT_TRUE(medium_.create("catalogue.sqlite", file).ok());
    EXPECT_EQ(take_first(medium_, source_).status().fault(), Fault::kUsage);
}

} // namespace
