#include "csv_lines.h"

#include "dicot/base/utc_time.h"
#include "dicot/schedule/schedule.h"
#include "dicot/schedule/sun.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

using testing::ElementsAre;

constexpr std::int64_t kSecondUs = 1'000'000;
constexpr std::int64_t kHourUs = 3600 * kSecondUs;

TimeZone zone(const std::string& name)
{
    return TimeZone::open(name, DICOT_SCHEDULE_DATA "/zoneinfo").value();
}

std::int64_t utc(const std::string& text)
{
    return parse_utc_text(text).value();
}

Schedule at(std::vector<std::string> times)
{
    ScheduleConfig words;
    words.at = std::move(times);
    words.latitude = 52.52;
    words.longitude = 13.405;
    return make_schedule(words).value();
}

Schedule every(const char* interval, const char* from = "00:00", const char* until = "24:00")
{
    ScheduleConfig words;
    words.every = interval;
    words.from = from;
    words.until = until;
    return make_schedule(words).value();
}

/// Each as "UTC why".
std::vector<std::string> slots(const Schedule& schedule, const TimeZone& zone, const std::string& after, int most)
{
    std::vector<std::string> found;
    SlotWalk walk(schedule, zone, utc(after));
    while (most-- > 0)
        if (const std::optional<Slot> slot = walk.next())
            found.push_back(std::string{utc_text(slot->due_us).c_str()} + " " + slot->why.c_str());
    return found;
}

// slots.csv: Python's zoneinfo and a plain loop over days, eighty years of nine zones; FNV-1a over all dues.
// "zones.py ZONE NAME" lists them.
TEST(SlotWalk, EightyYearsOfSlotsAreThoseOfPython)
{
    const std::map<std::string, Schedule> kSchedules = {
        {"morning", at({"06:30"})},
        {"night", at({"00:00", "00:01", "01:30", "01:59", "02:00", "02:30", "03:00", "23:59"})},
        {"hourly", every("1h")},
        {"daylight",
         [] {
             ScheduleConfig words;
             words.at = {"07:30"};
             words.every = "2h";
             words.from = "05:30";
             words.until = "19:30";
             return make_schedule(words).value();
         }()},
        {"odd",
         [] {
             ScheduleConfig words;
             words.at = {"12:01"};
             words.every = "1h17m";
             words.from = "00:01";
             words.until = "23:59";
             return make_schedule(words).value();
         }()},
    };
    std::size_t lists = 0;
    for (const auto& fields : test::csv_lines(DICOT_SCHEDULE_DATA "/slots.csv")) {
        ASSERT_EQ(fields.size(), 6U);
        SCOPED_TRACE(fields[0] + " " + fields[1]);
        const TimeZone here = zone(fields[0]);
        const std::int64_t last_s = std::stoll(fields[4]);
        SlotWalk walk(kSchedules.at(fields[1]), here, std::stoll(fields[3]) * kSecondUs - 1);
        std::uint64_t digest = 0xCBF29CE484222325;
        std::int64_t count = 0;
        for (auto slot = walk.next(); slot && slot->due_us <= last_s * kSecondUs; slot = walk.next(), ++count)
            digest = (digest ^ static_cast<std::uint64_t>(slot->due_us / kSecondUs)) * 0x100000001B3;
        EXPECT_EQ(count, std::stoll(fields[2]));
        EXPECT_EQ(digest, std::stoull(fields[5]));
        ++lists;
    }
    EXPECT_EQ(lists, 45U);
}

TEST(SlotWalk, BeginsAnywhereWithTheSameSlots)
{
    const TimeZone here = zone("Australia/Lord_Howe");
    const Schedule schedule = [] {
        ScheduleConfig words;
        words.at = {"02:15", "sunrise+10m", "01:45", "sunset-1h"};
        words.every = "25m";
        words.from = "01:00";
        words.until = "23:00";
        words.latitude = -31.55;
        words.longitude = 159.08;
        return make_schedule(words).value();
    }();
    SlotWalk walk(schedule, here, utc("2026-03-31T00:00:00Z"));
    std::int64_t before = utc("2026-03-31T00:00:00Z");
    for (int i = 0; i < 2000; ++i) {
        const std::optional<Slot> slot = walk.next();
        ASSERT_TRUE(slot.has_value());
        ASSERT_GT(slot->due_us, before);
        for (const std::int64_t after : {before, slot->due_us - 1, (before + slot->due_us) / 2}) {
            const std::optional<Slot> found = next_slot(schedule, here, after);
            ASSERT_TRUE(found.has_value());
            ASSERT_EQ(found->due_us, slot->due_us) << utc_text(after).c_str();
            ASSERT_EQ(found->why, slot->why);
        }
        before = slot->due_us;
    }
}

// RFC 5545, 3.3.5.
TEST(SlotWalk, ATimeThatClocksSkipIsTakenWithTheOffsetBefore)
{
    EXPECT_THAT(slots(at({"02:30"}), zone("Europe/Berlin"), "2026-03-28T12:00:00Z", 2),
                ElementsAre("2026-03-29T01:30:00Z 02:30", "2026-03-30T00:30:00Z 02:30"));
    EXPECT_THAT(slots(at({"02:30"}), zone("America/New_York"), "2026-03-08T00:00:00Z", 2),
                ElementsAre("2026-03-08T07:30:00Z 02:30", "2026-03-09T06:30:00Z 02:30"));
    EXPECT_THAT(slots(at({"02:10"}), zone("Australia/Lord_Howe"), "2026-10-03T12:00:00Z", 2),
                ElementsAre("2026-10-03T15:40:00Z 02:10", "2026-10-04T15:10:00Z 02:10"));
}

TEST(SlotWalk, ATimeThatComesTwiceIsTakenOnce)
{
    EXPECT_THAT(slots(at({"02:30"}), zone("Europe/Berlin"), "2026-10-24T12:00:00Z", 2),
                ElementsAre("2026-10-25T00:30:00Z 02:30", "2026-10-26T01:30:00Z 02:30"));
    EXPECT_THAT(slots(at({"02:30"}), zone("Europe/Berlin"), "2026-10-25T00:30:00Z", 1),
                ElementsAre("2026-10-26T01:30:00Z 02:30"));
    EXPECT_THAT(slots(at({"01:45"}), zone("Australia/Lord_Howe"), "2026-04-04T12:00:00Z", 2),
                ElementsAre("2026-04-04T14:45:00Z 01:45", "2026-04-05T15:15:00Z 01:45"));
}

TEST(SlotWalk, ADayThatApiaNeverHadBringsNothingTwice)
{
    EXPECT_THAT(slots(at({"06:30"}), zone("Pacific/Apia"), "2011-12-29T00:00:00Z", 4),
                ElementsAre("2011-12-29T16:30:00Z 06:30", "2011-12-30T16:30:00Z 06:30", "2011-12-31T16:30:00Z 06:30",
                            "2012-01-01T16:30:00Z 06:30"));
}

TEST(SlotWalk, SpacingIsTheSameOnDaysOf23And25Hours)
{
    const TimeZone berlin = zone("Europe/Berlin");
    const Schedule hourly = every("1h");
    const auto slots_of_day = [&](const char* first, int hours) {
        SlotWalk walk(hourly, berlin, utc(first) - 1);
        for (int i = 0; i < hours; ++i)
            EXPECT_EQ(walk.next()->due_us, utc(first) + i * kHourUs);
        return std::string{utc_text(berlin.local_us(walk.next()->due_us)).c_str()};
    };
    EXPECT_EQ(slots_of_day("2026-03-28T23:00:00Z", 23), "2026-03-30T00:00:00Z");
    EXPECT_EQ(slots_of_day("2026-10-24T22:00:00Z", 25), "2026-10-26T00:00:00Z");
}

TEST(SlotWalk, EveryIsCountedFromFromAndUntilIsIncluded)
{
    EXPECT_THAT(slots(every("2h", "06:00", "10:00"), TimeZone{}, "2026-06-01T00:00:00Z", 4),
                ElementsAre("2026-06-01T06:00:00Z every 2h", "2026-06-01T08:00:00Z every 2h",
                            "2026-06-01T10:00:00Z every 2h", "2026-06-02T06:00:00Z every 2h"));
    EXPECT_THAT(slots(every("2h", "06:00", "09:59"), TimeZone{}, "2026-06-01T08:00:00Z", 1),
                ElementsAre("2026-06-02T06:00:00Z every 2h"));
    EXPECT_THAT(
        slots(every("7h"), TimeZone{}, "2026-06-01T13:59:59Z", 3),
        ElementsAre("2026-06-01T14:00:00Z every 7h", "2026-06-01T21:00:00Z every 7h", "2026-06-02T00:00:00Z every 7h"));
}

TEST(SlotWalk, LeapDaysHaveSlotsAndNoOthers)
{
    EXPECT_THAT(slots(at({"12:00"}), TimeZone{}, "2028-02-28T12:00:00Z", 2),
                ElementsAre("2028-02-29T12:00:00Z 12:00", "2028-03-01T12:00:00Z 12:00"));
    EXPECT_THAT(slots(at({"12:00"}), TimeZone{}, "2027-02-28T12:00:00Z", 1), ElementsAre("2027-03-01T12:00:00Z 12:00"));
    EXPECT_THAT(slots(at({"12:00"}), TimeZone{}, "2100-02-28T12:00:00Z", 1), ElementsAre("2100-03-01T12:00:00Z 12:00"));
}

TEST(SlotWalk, SlotsOfOneSecondMeltIntoTheFirstOne)
{
    ScheduleConfig words;
    words.at = {"08:00", "06:00", "06:00"};
    words.every = "1h";
    words.from = "06:00";
    words.until = "09:00";
    EXPECT_THAT(slots(make_schedule(words).value(), TimeZone{}, "2026-06-01T00:00:00Z", 5),
                ElementsAre("2026-06-01T06:00:00Z 06:00", "2026-06-01T07:00:00Z every 1h", "2026-06-01T08:00:00Z 08:00",
                            "2026-06-01T09:00:00Z every 1h", "2026-06-02T06:00:00Z 06:00"));
}

TEST(SlotWalk, ThePlaceAndNotTheZoneMakesTheSun)
{
    // Almanacs of Berlin: 04:43 and 21:33 summer time.
    for (const char* name : {"Europe/Berlin", "Pacific/Apia", "America/New_York"})
        EXPECT_THAT(slots(at({"sunrise+30m", "sunset"}), zone(name), "2026-06-21T00:00:00Z", 3),
                    ElementsAre("2026-06-21T03:13:00Z sunrise+30m", "2026-06-21T19:33:00Z sunset",
                                "2026-06-22T03:13:00Z sunrise+30m"))
            << name;
}

TEST(SlotWalk, APolarDayHasNoSunriseAndTheSeriesGoesOn)
{
    ScheduleConfig words;
    words.at = {"sunrise"};
    words.latitude = 69.65;
    words.longitude = 18.96;
    const Schedule tromso = make_schedule(words).value();
    // Almanacs: the sun is up from 18 May to 26 July, and down from 27 November to 15 January.
    const TimeZone berlin = zone("Europe/Berlin");
    SlotWalk walk(tromso, berlin, utc("2026-01-01T00:00:00Z"));
    std::vector<std::int64_t> all;
    for (int i = 0; i < 600; ++i)
        all.push_back(walk.next()->due_us);
    std::vector<int> gaps; // days
    for (std::size_t i = 1; i < all.size(); ++i)
        if (all[i] - all[i - 1] > 30 * kHourUs)
            gaps.push_back(static_cast<int>((all[i] - all[i - 1]) / (24 * kHourUs)));
    ASSERT_EQ(gaps.size(), 4U);
    for (const std::size_t summer : {0U, 2U})
        EXPECT_NEAR(gaps[summer], 69, 4);
    for (const std::size_t winter : {1U, 3U})
        EXPECT_NEAR(gaps[winter], 49, 4);
}

TEST(SlotWalk, WhereThereIsNothingNothingIsFound)
{
    EXPECT_FALSE(next_slot(Schedule{}, TimeZone{}, 0).has_value());
    ScheduleConfig words;
    words.at = {"sunset"};
    words.latitude = 90;
    words.longitude = 0;
    EXPECT_FALSE(next_slot(make_schedule(words).value(), TimeZone{}, utc("2026-01-01T00:00:00Z")).has_value());
}

TEST(SlotWalk, AClockThatShowsNonsenseBreaksNothing)
{
    for (const std::int64_t clock :
         {INT64_MIN, kFirstUtcUs, std::int64_t{-1}, std::int64_t{0}, kLastUtcUs, INT64_MAX}) {
        const std::optional<Slot> slot = next_slot(every("1m"), zone("Europe/Berlin"), clock);
        EXPECT_TRUE(slot ? slot->due_us > clock : clock >= kLastUtcUs) << clock;
        (void)next_slot(at({"sunrise"}), zone("Europe/Berlin"), clock);
    }
}

} // namespace
} // namespace dicot::app
