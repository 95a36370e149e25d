#include "dicot/schedule/schedule.h"

#include <gtest/gtest.h>

#include <cstring>

namespace dicot::app {
namespace {

using After = Moment::After;

TEST(ScheduleWords, MomentsAreReadAsWritten)
{
    EXPECT_EQ(parse_moment("00:00"), (Moment{After::kMidnight, 0}));
    EXPECT_EQ(parse_moment("06:30"), (Moment{After::kMidnight, 23'400}));
    EXPECT_EQ(parse_moment("23:59"), (Moment{After::kMidnight, 86'340}));
    EXPECT_EQ(parse_moment("sunrise"), (Moment{After::kSunrise, 0}));
    EXPECT_EQ(parse_moment("sunrise+30m"), (Moment{After::kSunrise, 1800}));
    EXPECT_EQ(parse_moment("sunset-1h30m"), (Moment{After::kSunset, -5400}));
    EXPECT_EQ(parse_moment("sunset+12h"), (Moment{After::kSunset, 43'200}));
    for (const char* wrong : {"",
                              "6:30",
                              "06:60",
                              "24:00",
                              "24:01",
                              "06:3",
                              "06-30",
                              "06:30 ",
                              " 06:30",
                              "-1:30",
                              "+6:30",
                              "0630",
                              "06:30:00",
                              "sunrise ",
                              "sunrise30m",
                              "sunrise+",
                              "sunrise-",
                              "sunrise+-30m",
                              "sunrise+30",
                              "sunrise+12h1m",
                              "sunset+13h",
                              "Sunrise",
                              "noon",
                              "sunrises",
                              "sunrise+1h60m",
                              "sunrise+0000000030m"})
        EXPECT_FALSE(parse_moment(wrong).has_value()) << wrong;
}

TEST(ScheduleWords, DurationsAreHoursAndMinutes)
{
    EXPECT_EQ(parse_duration_s("1m"), 60);
    EXPECT_EQ(parse_duration_s("90m"), 5400);
    EXPECT_EQ(parse_duration_s("2h"), 7200);
    EXPECT_EQ(parse_duration_s("1h30m"), 5400);
    EXPECT_EQ(parse_duration_s("24h"), 86'400);
    EXPECT_EQ(parse_duration_s("1440m"), 86'400);
    for (const char* wrong : {"", "h", "m", "30", "30s", "1441m", "24h1m", "25h", "1h60m", "30m1h", "1 h", "-1h", "+1h",
                              "1h30", "1.5h", "1h1h", "99999999999h", "000030m"})
        EXPECT_FALSE(parse_duration_s(wrong).has_value()) << wrong;
    EXPECT_TRUE(is_interval(""));
    EXPECT_TRUE(is_interval("1m"));
    EXPECT_FALSE(is_interval("0m"));
    EXPECT_FALSE(is_interval("0h"));
}

TEST(ScheduleWords, EveryWordOfAMomentFitsIntoItsSlot)
{
    for (const char* longest : {"sunrise-11h59m", "sunset+0h59m", "sunrise-0720m"}) {
        ScheduleConfig words;
        words.at = {longest};
        words.latitude = words.longitude = 0;
        ASSERT_TRUE(parse_moment(longest).has_value()) << longest;
        EXPECT_STREQ(make_schedule(words).value().at().front().word.c_str(), longest);
    }
    ScheduleConfig words;
    words.every = "23h59m";
    EXPECT_STREQ(make_schedule(words).value().every_word.c_str(), "every 23h59m");
}

TEST(ScheduleWords, ContradictionsNameTheirKeys)
{
    const auto keys = [](const ScheduleConfig& words) {
        std::string named;
        if (const std::optional<Contradiction> found = contradiction_in(words))
            for (const char* key : found->keys)
                named += std::string{key} + " ";
        return named;
    };
    ScheduleConfig words;
    EXPECT_EQ(keys(words), "");
    words.at = {"06:30", "sunset"};
    words.latitude = 52.5;
    EXPECT_EQ(keys(words), "at latitude longitude ");
    words.longitude = 13.4;
    EXPECT_EQ(keys(words), "");
    words.from = "20:00";
    words.until = "20:00";
    EXPECT_EQ(keys(words), "from until ");
    words.until = "21:00";
    words.every = "1h";
    EXPECT_EQ(keys(words), "");
    words.every = "61m";
    EXPECT_EQ(keys(words), "every from until ");
    EXPECT_EQ(make_schedule(words).status().fault(), Fault::kConfig);
}

TEST(ScheduleWords, MoreTimesThanThereIsRoomForAreRefused)
{
    ScheduleConfig words;
    words.at.assign(Schedule::kMostMoments, "12:00");
    EXPECT_TRUE(make_schedule(words).ok());
    words.at.emplace_back("12:00");
    EXPECT_EQ(make_schedule(words).status().fault(), Fault::kConfig);
    words.at = {"noon"};
    EXPECT_NE(std::strstr(make_schedule(words).status().message(), "noon"), nullptr);
}

} // namespace
} // namespace dicot::app
