// What is missing in an archive, and why; ranges of numbers.
#include "crash_medium.h"
#include "pull_scene.h"

using namespace dicot;
using namespace dicot::test;

namespace {

NumberRanges ranges_of(const char* text)
{
    const auto ranges = NumberRanges::parse(text);
    EXPECT_TRUE(ranges.has_value()) << text;
    return ranges.value_or(NumberRanges{});
}

TEST(NumberRanges, are_read_as_they_are_written)
{
    for (const char* const text : {"", "1", "1-2", "1,3", "1-20,25,30-41", "999999999"})
        EXPECT_EQ(ranges_of(text).text(), text);
    for (const char* const text : {"0", "01", "2-1", "1-1", "1,2", "1,1", "3,1", "1-", "-1", ",", "1,", ",1", "1 ", "a",
                                   "1000000000", "1-1000000000", "99999999999999999999", "+1"})
        EXPECT_FALSE(NumberRanges::parse(text).has_value()) << text;
}

TEST(NumberRanges, know_what_is_absent_common_and_left)
{
    const NumberRanges some = ranges_of("3-5,8,10-12");
    EXPECT_EQ(some.count(), 7);
    EXPECT_EQ(some.absent(1, 14).text(), "1-2,6-7,9,13-14");
    EXPECT_EQ(some.absent(4, 11).text(), "6-7,9");
    EXPECT_EQ(some.common(ranges_of("1-3,5-10")).text(), "3,5,8,10");
    EXPECT_EQ(some.without(ranges_of("4,8,12-20")).text(), "3,5,10-11");
    EXPECT_EQ(some.together(ranges_of("1,6-7,9,20")).text(), "1,3-12,20");
    EXPECT_TRUE(some.has(3) && some.has(5) && some.has(8) && !some.has(2) && !some.has(6) && !some.has(13));
    EXPECT_TRUE(NumberRanges{}.absent(1, 0).empty());
}

class PullGaps : public ::testing::Test
{
protected:
    void pull(std::initializer_list<int> numbers, const char* had)
    {
        const auto archive = BoardArchive::open(medium_, source_.serial());
        ASSERT_TRUE(archive.ok());
        for (const int number : numbers) {
            source_.all.push_back(honest(number, kNoon, 100));
            const Result<Taken> taken = archive.value()->take(source_, source_.all.back().offer, false, goes_on);
            ASSERT_TRUE(taken.ok() && taken.value().how == Took::kNew);
        }
        ASSERT_TRUE(archive.value()->note({kNoon, ranges_of(had)}).ok());
    }
    ArchiveLook look()
    {
        Result<ArchiveLook> looked = look_at_archive(
            medium_, [&](const RecordFacts& facts) { misses_ += facts.done ? 0 : 1; },
            [&](const Status& flaw) { flaws_.emplace_back(flaw.message()); });
        EXPECT_TRUE(looked.ok());
        return looked.ok() ? looked.value() : ArchiveLook{};
    }
    std::vector<std::string> flaws_of_check()
    {
        std::vector<std::string> flaws;
        const auto checked = check_archive(
            medium_, [&](const Status& flaw) { flaws.emplace_back(flaw.message()); },
            [](std::int64_t, std::int64_t) { return true; });
        EXPECT_TRUE(checked.ok());
        return flaws;
    }

    CrashMedium medium_;
    ScriptedSource source_;
    int misses_ = 0;
    std::vector<std::string> flaws_;
};

TEST_F(PullGaps, are_told_apart_by_what_the_board_had)
{
    pull({4, 5, 8}, "4-5,7-8,10");
    const ArchiveLook seen = look();
    EXPECT_EQ(seen.snapshots, 3);
    EXPECT_EQ(seen.here.text(), "4-5,8");
    EXPECT_EQ(seen.waiting.text(), "7,10") << "the board still has them";
    EXPECT_EQ(seen.lost.text(), "1-3,6,9") << "it had them no more";
    EXPECT_EQ(seen.pulled_us, kNoon);
    EXPECT_EQ(seen.serial, "10000000a");
    ASSERT_TRUE(seen.newest.has_value());
    EXPECT_EQ(seen.newest->sequence, 8);
}

TEST_F(PullGaps, are_not_told_of_by_a_card_that_knows_less_than_the_board)
{
    pull({1}, "1-9");
    source_.serial_number = "";
    pull({2}, "2,12");
    EXPECT_EQ(look().waiting.text(), "3-9,12");
}

TEST_F(PullGaps, do_not_hide_what_is_half_pulled)
{
    source_.all.push_back(honest(1, kNoon, 1000));
    source_.reads_left = 10;
    EXPECT_FALSE(take_first(medium_, source_).ok());
    const ArchiveLook seen = look();
    EXPECT_EQ(seen.incomplete, 1);
    EXPECT_GT(seen.incomplete_bytes, 100U);
    EXPECT_EQ(seen.snapshots, 0);
    source_.reads_left = std::numeric_limits<std::uint64_t>::max();
    pull({}, "2-3");
    EXPECT_EQ(look().incomplete, 0) << "the board has it no more: nobody will end it";
}

TEST_F(PullGaps, name_the_misses)
{
    ScriptedSnapshot miss = honest(1, kNoon, 0);
    miss.files = with_sums({{"record.json", record_of(1, kNoon, false)}});
    miss.offer.sums.reset();
    source_.all.push_back(miss);
    ASSERT_TRUE(take_first(medium_, source_).ok());
    EXPECT_EQ(look().missed, 1);
    EXPECT_EQ(misses_, 1);
}

TEST_F(PullGaps, are_checked_byte_by_byte)
{
    pull({1, 2}, "1-2");
    EXPECT_TRUE(flaws_of_check().empty());
    const int node = medium_.find_file((std::string{kFirstFolder} + "/cloud.drc").c_str());
    ASSERT_TRUE(medium_.write_at(node, 50, std::as_bytes(std::span("#", 1))).ok());
    const std::vector<std::string> flaws = flaws_of_check();
    ASSERT_EQ(flaws.size(), 1U);
    EXPECT_NE(flaws[0].find("000001_20260601T120000Z/cloud.drc"), std::string::npos) << flaws[0];
    ASSERT_TRUE(medium_.make_folder("2026-06-02").ok());
    ASSERT_TRUE(medium_.make_folder("2026-06-02/000002_20260602T120000Z").ok());
    EXPECT_EQ(flaws_of_check().size(), 3U) << "a second folder of a number, without a file";
    (void)look();
    EXPECT_EQ(flaws_.size(), 1U);
}

} // namespace
