// Times, figures and records as the commands of a store word them.
#include "store/record_words.h"
#include "store/shown.h"
#include "store/slot_words.h"

#include "dicot/base/utc_time.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace dicot::app {
namespace {

using nlohmann::json;

std::string span_of(const char* text)
{
    const std::optional<TimeSpan> span = parse_time(text);
    return span ? std::string(utc_text(span->first_us).c_str()) + " " + utc_text(span->last_us).c_str() : "none";
}

TEST(StoreWords, ADayAMinuteAndASecondCoverThemselves)
{
    EXPECT_EQ(span_of("2024-02-29"), "2024-02-29T00:00:00Z 2024-02-29T23:59:59Z");
    EXPECT_EQ(span_of("2026-06-01T12:30"), "2026-06-01T12:30:00Z 2026-06-01T12:30:59Z");
    EXPECT_EQ(span_of("2026-06-01T12:30Z"), span_of("2026-06-01T12:30"));
    EXPECT_EQ(span_of("2026-06-01T12:30:15Z"), "2026-06-01T12:30:15Z 2026-06-01T12:30:15Z");
    for (const char* none :
         {"", "2026", "2023-02-29", "2026-06-01Z", "2026-06-01T12", "2026-06-01T12:30:15+02:00", "1-1-1"})
        EXPECT_EQ(span_of(none), "none") << none;
}

TEST(StoreWords, WhatATerminalWouldObeyIsEscaped)
{
    EXPECT_EQ(shown("Wand ä \\ 3"), "Wand ä \\ 3");
    EXPECT_EQ(shown("a\x1b[2J\n\xFF"), "a\\x1B[2J\\x0A\\xFF");
    EXPECT_EQ(shown("\xE2\x80\xAE"
                    "abc"),
              "\\xE2\\x80\\xAE"
              "abc"); // turns the direction of writing
    EXPECT_EQ(shown(std::string(300, 'x')), std::string(200, 'x') + "...");
}

TEST(StoreWords, BytesAreShownInTheUnitThatFits)
{
    EXPECT_EQ(shown_bytes(0), "0 B");
    EXPECT_EQ(shown_bytes(1023), "1023 B");
    EXPECT_EQ(shown_bytes(1536), "1.5 KiB");
    EXPECT_EQ(shown_bytes(5.0 * (1 << 20)), "5.0 MiB");
    EXPECT_EQ(shown_bytes(3.0 * (1LL << 40)), "3.0 TiB");
}

/// Every value of a record in turn made something else.
void spoil(json& record, json& at, const std::vector<json>& others, int& spoiled)
{
    for (json& value : at) {
        const json before = value;
        for (const json& other : others) {
            value = other;
            const std::string words = record_words(record);
            EXPECT_EQ(words.find('\x1b'), std::string::npos) << words;
            ++spoiled;
        }
        value = before;
        if (value.is_structured())
            spoil(record, value, others, spoiled);
    }
}

TEST(StoreWords, ARecordOfAnyShapeGivesWordsAndNothingToObey)
{
    json record = {
        {"source", "cameras"},
        {"cloud",
         {{"points", 7},
          {"bits_per_point", 30.5},
          {"near_mm", 300},
          {"far_mm", 900},
          {"stages_s", {{"read", 1}, {"rectify", 2}, {"match", 3}, {"encode", 4}}}}},
        {"shot", {{"pairs_used", 1}, {"pairs", 2}, {"skew_us", 1500}, {"mean_luma", {{"left", 1}, {"right", 2}}}}},
        {"cameras", {{"left", {{"name", "a"}, {"port", "1-1"}, {"driver", "uvc"}}}, {"right", {{"name", "b"}}}}},
        {"calibration_id", "rig-1"},
        {"clock", {{"why", "so"}}},
        {"temperatures_c", {{"thermal/soc", 41.26}}},
        {"memory", {{"arena_bytes", 1}, {"peak_resident_bytes", 2}}},
        {"warnings", {"dark"}},
        {"software", "dicot"}};
    const std::string words = record_words(record);
    for (const char* part : {"7 points, 30.5 bits each; 300 to 900 mm", "1 of 2 pairs used, skew 1.5 ms",
                             "a at 1-1 through uvc", "thermal/soc 41.3 C", "rig-1", "dark"})
        EXPECT_NE(words.find(part), std::string::npos) << part << "\n" << words;
    const std::vector<json> others = {nullptr,           true, -1e300, "\x1b[31m\xFF", json::array({1, json::object()}),
                                      {{"\x1b", "\x1b"}}};
    int spoiled = 0;
    spoil(record, record, others, spoiled);
    EXPECT_GT(spoiled, 200);
    for (const json& other : others)
        EXPECT_EQ(record_words(other).find('\x1b'), std::string::npos);
}

} // namespace
} // namespace dicot::app
