#include "csv_lines.h"

#include "dicot/base/utc_time.h"
#include "dicot/schedule/sun.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

namespace dicot::app {
namespace {

constexpr std::int64_t kMinuteUs = 60'000'000;

std::int64_t at(const char* text)
{
    return parse_utc_text(text).value();
}

/// The event of the solar day that `published` lies in is less than two minutes from it.
void expect_near(SunEvent event, const char* published, double latitude, double longitude)
{
    const std::int64_t wanted = at(published);
    const auto got = sun_us(event, solar_day(wanted, longitude), latitude, longitude);
    ASSERT_TRUE(got.has_value()) << published;
    EXPECT_LT(std::llabs(*got - wanted), 2 * kMinuteUs) << published << " but " << utc_text(*got).c_str();
}

// I. Reda, A. Andreas: Solar Position Algorithm for Solar Radiation Applications, NREL/TP-560-34302, 2008: the example
// of Golden, Colorado, which its program prints: sunrise 06:12:43, sunset 17:20:19, seven hours behind UTC.
TEST(Sun, RisesAndSetsAsInTheExampleOfNrel)
{
    expect_near(SunEvent::kRise, "2003-10-17T13:12:43Z", 39.742476, -105.1786);
    expect_near(SunEvent::kSet, "2003-10-18T00:20:19Z", 39.742476, -105.1786);
}

// sun.csv is made by another library, with another theory of the sun: 130 years, places from 55 S to 78 N.
TEST(Sun, RisesAndSetsAsInTheTableOfPyEphem)
{
    int events = 0;
    int days_without = 0;
    for (const auto& fields : test::csv_lines(DICOT_SCHEDULE_DATA "/sun.csv")) {
        ASSERT_EQ(fields.size(), 6U);
        const double latitude = std::stod(fields[1]);
        const double longitude = std::stod(fields[2]);
        const std::int64_t day = std::stoll(fields[3]);
        const std::int64_t most_us = std::abs(latitude) < 60   ? kMinuteUs * 3 / 2
                                     : std::abs(latitude) < 66 ? 2 * kMinuteUs
                                                               : 10 * kMinuteUs;
        for (const SunEvent event : {SunEvent::kRise, SunEvent::kSet}) {
            const std::string& wanted = fields[event == SunEvent::kRise ? 4 : 5];
            SCOPED_TRACE(fields[0] + ", day " + fields[3] + (event == SunEvent::kRise ? ", rise" : ", set"));
            const auto got = sun_us(event, day, latitude, longitude);
            ASSERT_EQ(got.has_value(), wanted != "-");
            if (!got) {
                ++days_without;
                continue;
            }
            ++events;
            EXPECT_EQ(*got % kMinuteUs, 0);
            EXPECT_LE(std::llabs(*got - std::stoll(wanted) * 1'000'000), most_us) << utc_text(*got).c_str();
        }
    }
    EXPECT_GT(events, 1000);
    EXPECT_GT(days_without, 100);
}

TEST(Sun, ADayIsOneOfThePlaceWhereverItIs)
{
    EXPECT_EQ(solar_day(at("1970-01-01T00:00:00Z"), 0), 0);
    EXPECT_EQ(solar_day(at("1970-01-01T11:59:00Z"), 180), 0);
    EXPECT_EQ(solar_day(at("1970-01-01T12:01:00Z"), 180), 1);
    EXPECT_EQ(solar_day(at("1970-01-01T11:59:00Z"), -180), -1);
    EXPECT_EQ(solar_day(at("1970-01-01T00:30:00Z"), -15), -1);
}

TEST(Sun, PolesAndNonsenseHaveNoSunrise)
{
    for (std::int64_t day = 0; day < 366; ++day)
        for (const double latitude : {90.0, -90.0}) {
            const auto got = sun_us(SunEvent::kRise, day, latitude, 0);
            EXPECT_FALSE(got.has_value()) << day;
        }
    EXPECT_FALSE(sun_us(SunEvent::kRise, 0, std::nan(""), 0).has_value());
}

} // namespace
} // namespace dicot::app
