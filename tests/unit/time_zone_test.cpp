#include "csv_lines.h"
#include "temp_folder.h"
#include "zone_file.h"

#include "dicot/base/utc_time.h"
#include "dicot/os/time_zone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <string>

namespace dicot {
namespace {

constexpr const char* kZones = DICOT_SCHEDULE_DATA "/zoneinfo";
constexpr std::int64_t kSecondUs = 1'000'000;
constexpr std::int64_t kDayS = 86'400;

TimeZone zone(const std::string& name)
{
    Result<TimeZone> opened = TimeZone::open(name, kZones);
    EXPECT_TRUE(opened.ok()) << opened.status().message();
    return opened.ok() ? opened.value() : TimeZone{};
}

std::int64_t utc_s_of(const TimeZone& zone, std::int64_t local_s)
{
    return zone.utc_us(local_s / kDayS, static_cast<int>(local_s % kDayS)) / kSecondUs;
}

/// What is wrong with a file of these bytes; nothing if nothing is.
std::string complaint(const test::Bytes& bytes)
{
    ZoneTable table;
    const char* wrong = read_zone_file(std::as_bytes(std::span{bytes}), table);
    EXPECT_LE(table.changes, ZoneTable::kMostChanges);
    return wrong != nullptr ? wrong : "";
}

// changes.csv has every change from 1970 to 2100 as Python's zoneinfo finds it, and what it takes local times at its
// brinks for.
TEST(TimeZone, ChangesAreThoseOfPython)
{
    std::string open;
    TimeZone here;
    std::size_t next = 0;
    for (const auto& fields : test::csv_lines(DICOT_SCHEDULE_DATA "/changes.csv")) {
        ASSERT_EQ(fields.size(), 14U);
        if (fields[0] != open) {
            here = zone(open = fields[0]);
            next = 0;
        }
        const std::int64_t at_s = std::stoll(fields[1]);
        SCOPED_TRACE(open + " " + utc_text(at_s * kSecondUs).c_str());
        ASSERT_LT(next, static_cast<std::size_t>(here.table().changes));
        EXPECT_EQ(here.table().from_s[next++], at_s) << "a change is missing, or there is one too many";
        EXPECT_EQ(here.offset_s(at_s * kSecondUs - 1), std::stoi(fields[2]));
        EXPECT_EQ(here.offset_s(at_s * kSecondUs), std::stoi(fields[3]));
        for (std::size_t probe = 4; probe < fields.size(); probe += 2)
            EXPECT_EQ(utc_s_of(here, at_s + std::stoll(fields[probe])), at_s + std::stoll(fields[probe + 1])) << probe;
    }
    EXPECT_EQ(open, "Europe/Dublin") << "the table is cut";
}

TEST(TimeZone, EveryZoneOfThisSystemIsAsLibcHasIt)
{
    std::ifstream source{"/usr/share/zoneinfo/tzdata.zi"};
    std::set<std::string> names;
    for (std::string line; std::getline(source, line);) {
        const std::size_t blank = line.find(' ', 2);
        if (line.starts_with("Z "))
            names.insert(line.substr(2, blank - 2));
        else if (line.starts_with("L "))
            names.insert(line.substr(blank + 1));
    }
    ASSERT_GT(names.size(), 400U) << "install tzdata";
    const char* const before = std::getenv("TZ");
    const std::string kept = before != nullptr ? before : "";
    std::mt19937_64 random{6};
    std::uniform_int_distribution<std::int64_t> seconds{0, sizeof(std::time_t) > 4 ? 4'102'444'800 : INT32_MAX};
    for (const std::string& name : names) {
        const Result<TimeZone> here = TimeZone::open(name);
        ASSERT_TRUE(here.ok()) << here.status().message();
        ::setenv("TZ", (":" + name).c_str(), 1);
        ::tzset();
        for (int i = 0; i < 100; ++i) {
            const auto at = static_cast<std::time_t>(seconds(random));
            std::tm local{};
            ASSERT_NE(::localtime_r(&at, &local), nullptr);
            ASSERT_EQ(here.value().offset_s(at * kSecondUs), local.tm_gmtoff) << name << " " << at;
        }
    }
    EXPECT_TRUE((before != nullptr ? ::setenv("TZ", kept.c_str(), 1) : ::unsetenv("TZ")) == 0);
    ::tzset();
}

TEST(TimeZone, RulesOfPosixAreThoseOfTheirZones)
{
    const std::pair<const char*, const char*> kSame[] = {
        {"CET-1CEST,M3.5.0,M10.5.0/3", "Europe/Berlin"},
        {"EST5EDT,M3.2.0,M11.1.0", "America/New_York"},
        {"<+1030>-10:30<+11>-11,M10.1.0,M4.1.0", "Australia/Lord_Howe"},
        {"<+0545>-5:45", "Asia/Kathmandu"},
    };
    const std::int64_t first = *parse_utc_text("2010-01-01T00:00:00Z");
    const std::int64_t last = *parse_utc_text("2100-12-31T00:00:00Z");
    for (const auto& [rule, name] : kSame) {
        const TimeZone by_rule = zone(rule);
        const TimeZone by_name = zone(name);
        for (std::int64_t at = first; at < last; at += 3600 * kSecondUs)
            ASSERT_EQ(by_rule.offset_s(at), by_name.offset_s(at)) << rule << " " << utc_text(at).c_str();
    }
}

TEST(TimeZone, DatesOfRulesAreCountedAsPosixCounts)
{
    // J60 is 1 March in every year, 59 is 29 February in leap years; hours may reach into other days (RFC 8536).
    const TimeZone here = zone("AAA0BBB,J60/0,59/-24");
    EXPECT_EQ(here.offset_s(*parse_utc_text("2023-02-28T12:00:00Z")), 0);
    EXPECT_EQ(here.offset_s(*parse_utc_text("2023-03-01T00:00:00Z")), 3600);
    EXPECT_EQ(here.offset_s(*parse_utc_text("2024-02-27T22:59:59Z")), 3600);
    EXPECT_EQ(here.offset_s(*parse_utc_text("2024-02-27T23:00:00Z")), 0);
    EXPECT_EQ(here.offset_s(*parse_utc_text("2024-02-29T23:59:59Z")), 0);
    EXPECT_EQ(here.offset_s(*parse_utc_text("2024-03-01T00:00:00Z")), 3600);
    const TimeZone always = zone("XXX3EDT4,0/0,J365/23"); // all the year: RFC 8536, 3.3.1
    for (int year = 2000; year < 2030; ++year)
        EXPECT_EQ(always.offset_s(*parse_utc_text(std::to_string(year) + "-01-01T12:00:00Z")), -4 * 3600);
    EXPECT_EQ(zone("AAA-1:02:03").offset_s(0), 3723);
}

TEST(TimeZone, ASlimFileAndAFatOneAreOneZone)
{
    const TimeZone fat = zone("Europe/Berlin");
    const TimeZone slim = zone("slim/Berlin");
    ASSERT_EQ(fat.table().changes, slim.table().changes);
    EXPECT_EQ(fat.table().from_s, slim.table().from_s);
    EXPECT_EQ(fat.table().offset_s, slim.table().offset_s);
}

TEST(TimeZone, WhatIsNoZoneIsRefused)
{
    for (const char* name : {"Europe/Berln",
                             "Berlin",
                             "europe/berlin",
                             "UTC+",
                             "CET",
                             "CET-1CEST",
                             "CET-1CEST,M3.5.0",
                             "CET-25",
                             "CE-1",
                             "CET-1CEST,M13.5.0,M10.5.0",
                             "CET-1CEST,M3.6.0,M10.5.0",
                             "CET-1CEST,M3.5.7,M10.5.0",
                             "CET-1CEST,J0,J365",
                             "CET-1CEST,366,1",
                             "CET-1CEST,M3.5.0,M10.5.0/168",
                             "CET-1CEST,M3.5.0,M10.5.0 ",
                             "<+1-1",
                             "<a>1",
                             "CET-1:60",
                             "../Europe/Berlin",
                             "/etc/localtime",
                             "Europe",
                             "Europe/",
                             ".",
                             ":Europe/Berlin",
                             " "}) {
        const Status status = TimeZone::open(name, kZones).status();
        EXPECT_EQ(status.fault(), Fault::kConfig) << name;
    }
    EXPECT_NE(std::string{TimeZone::open("Mars", kZones).status().message()}.find("no time zone \"Mars\""),
              std::string::npos);
    const std::string leaps = TimeZone::open("right/Berlin", kZones).status().message();
    EXPECT_NE(leaps.find("leap seconds"), std::string::npos) << leaps;
}

TEST(TimeZone, NoDamageOfAFileIsTakenForAZone)
{
    const test::Bytes whole = test::bytes_of(std::string{kZones} + "/Africa/Casablanca");
    ASSERT_EQ(complaint(whole), "");
    for (std::size_t cut = 0; cut < whole.size(); ++cut) {
        const std::string why = complaint({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut)});
        EXPECT_NE(why, "") << cut << " of " << whole.size();
    }
    std::mt19937 random{7};
    for (int i = 0; i < 20'000; ++i) { // no promise but to come back, within bounds
        test::Bytes mangled = whole;
        for (int k = 0; k < 3; ++k)
            mangled[random() % mangled.size()] = static_cast<test::Bytes::value_type>(random());
        (void)complaint(mangled);
    }
}

TEST(TimeZone, TheSystemsZoneIsCalledByItsName)
{
    const test::TempFolder folder;
    const std::string link = folder.path("localtime");
    EXPECT_STREQ(TimeZone::open("", kZones, link.c_str()).value().name(), "UTC");
    std::filesystem::create_symlink(std::string{kZones} + "/Asia/Kathmandu", link);
    const TimeZone by_link = TimeZone::open("", kZones, link.c_str()).value();
    EXPECT_STREQ(by_link.name(), "Asia/Kathmandu");
    EXPECT_EQ(by_link.offset_s(*parse_utc_text("2026-01-01T00:00:00Z")), 20'700);
    std::filesystem::remove(link);
    std::filesystem::copy_file(std::string{kZones} + "/Asia/Kathmandu", link);
    EXPECT_STREQ(TimeZone::open("", kZones, link.c_str()).value().name(), "local time");
    folder.write("localtime", "TZif");
    EXPECT_EQ(TimeZone::open("", kZones, link.c_str()).status().fault(), Fault::kConfig);
}

TEST(TimeZone, DaysBefore1970AndAfter2100HaveTheNearestOffset)
{
    const TimeZone berlin = zone("Europe/Berlin");
    EXPECT_EQ(berlin.offset_s(kFirstUtcUs), 3600);
    EXPECT_EQ(berlin.offset_s(kLastUtcUs), 3600);
    EXPECT_EQ(berlin.local_day(-1), 0); // 23:59:59.999999 UTC is past midnight in Berlin
    EXPECT_EQ(zone("America/New_York").local_day(0), -1);
    EXPECT_EQ(berlin.utc_us(-1, 86'400), -3600 * kSecondUs);
}

TEST(TimeZone, OffsetsArePrintedAsIsoHasThem)
{
    EXPECT_STREQ(offset_text(0).c_str(), "+00:00");
    EXPECT_STREQ(offset_text(20'700).c_str(), "+05:45");
    EXPECT_STREQ(offset_text(-12'600).c_str(), "-03:30");
    EXPECT_STREQ(offset_text(-2670).c_str(), "-00:44:30");
}

} // namespace
} // namespace dicot
