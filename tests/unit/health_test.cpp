// What is flagged of figures that are given, and what figures are found in any record.
#include "health/health_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <random>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

HealthFigures good()
{
    HealthFigures figures;
    figures.done = true;
    figures.calibration_id = "rig-1";
    figures.left = {118, 0.001, 52};
    figures.right = {120, 0.002, 50};
    figures.epipolar = HealthEpipolar{.median_px = 0.05, .spread_px = 0.04, .corner_px = 0.1, .points = 300};
    figures.skew_ms = 1.5;
    figures.most_skew_ms = 10;
    figures.fill = 0.8;
    figures.hottest_c = 45;
    figures.clock_trust = "synchronised";
    figures.clock_error_s = 0.01;
    figures.card = {200, 9000, 0};
    return figures;
}

HealthHistory history_of(const HealthFigures& figures, int snapshots)
{
    HealthHistory history;
    for (int i = 0; i < snapshots; ++i)
        history.add(figures);
    return history;
}

std::vector<std::string> ids(const HealthFlags& flags)
{
    std::vector<std::string> all;
    for (const HealthFlag& flag : flags)
        all.emplace_back(flag.id);
    return all;
}

/// The flags of good figures that were spoilt, after ten good ones.
template <typename Spoil>
HealthFlags spoilt(const Spoil& spoil)
{
    HealthFigures figures = good();
    spoil(figures);
    return judge_health(history_of(good(), 10), figures);
}

TEST(Health, AGoodSnapshotIsNotFlaggedWithOrWithoutAHistory)
{
    EXPECT_THAT(ids(judge_health({}, good())), IsEmpty());
    EXPECT_THAT(ids(judge_health(history_of(good(), 64), good())), IsEmpty());
    HealthFigures unknown;
    unknown.done = true;
    EXPECT_THAT(ids(judge_health(history_of(good(), 64), unknown)), IsEmpty()) << "what is not known is not flagged";
}

TEST(Health, EachFaultHasItsFlagWithFiguresAndAnAction)
{
    const struct
    {
        const char* id;
        Severity severity;
        const char* figure;
        void (*spoil)(HealthFigures&);
    } kCases[] = {
        {"dark", Severity::kNotice, "40", [](HealthFigures& f) { f.left.luma = f.right.luma = 40; }},
        {"dark", Severity::kWarning, "12", [](HealthFigures& f) { f.left.luma = f.right.luma = 12; }},
        {"overexposed", Severity::kWarning, "7.5 %", [](HealthFigures& f) { f.right.saturated = 0.075; }},
        {"overexposed", Severity::kNotice, "220", [](HealthFigures& f) { f.left.luma = f.right.luma = 220; }},
        {"blurred", Severity::kWarning, "29 of 100, and 50",
         [](HealthFigures& f) {
             f.left.focus = 32;
             f.right.focus = 29;
         }},
        {"unequal", Severity::kWarning, "118 left, 90 right", [](HealthFigures& f) { f.right.luma = 90; }},
        {"drift", Severity::kWarning, "0.31 px apart, and were 0.05",
         [](HealthFigures& f) { f.epipolar->median_px = 0.31; }},
        {"drift", Severity::kWarning, "-0.22 px apart", [](HealthFigures& f) { f.epipolar->median_px = -0.22; }},
        {"drift", Severity::kAlarm, "1.40 px", [](HealthFigures& f) { f.epipolar->median_px = 1.4; }},
        {"drift", Severity::kWarning, "0.80 px apart in a corner",
         [](HealthFigures& f) { f.epipolar->corner_px = 0.8; }},
        {"skew", Severity::kWarning, "7.0 ms", [](HealthFigures& f) { f.skew_ms = -7; }},
        {"few_points", Severity::kWarning, "40 % of the picture", [](HealthFigures& f) { f.fill = 0.4; }},
        {"cameras", Severity::kNotice, "2 times", [](HealthFigures& f) { f.shakes = 2; }},
        {"card", Severity::kWarning, "9.0 more days", [](HealthFigures& f) { f.card.days_left = 9; }},
        {"card", Severity::kAlarm, "1.5 more days", [](HealthFigures& f) { f.card.days_left = 1.5; }},
        {"card", Severity::kAlarm, "20 MiB", [](HealthFigures& f) { f.card.room_mib = 20; }},
        {"card", Severity::kWarning, "3 snapshots", [](HealthFigures& f) { f.card.in_quarantine = 3; }},
        {"clock", Severity::kWarning, "not set", [](HealthFigures& f) { f.clock_trust = "not set"; }},
        {"clock", Severity::kNotice, "2.5 s", [](HealthFigures& f) { f.clock_error_s = 2.5; }},
        {"hot", Severity::kWarning, "83", [](HealthFigures& f) { f.hottest_c = 83; }},
        {"hot", Severity::kNotice, "65 degrees Celsius, and 45 is usual", [](HealthFigures& f) { f.hottest_c = 65; }},
        {"start", Severity::kNotice, "found 2", [](HealthFigures& f) { f.repairs.interrupted = 2; }},
    };
    for (const auto& one : kCases) {
        const HealthFlags flags = spoilt(one.spoil);
        ASSERT_THAT(ids(flags), ElementsAre(one.id)) << one.figure;
        EXPECT_EQ(flags.begin()->severity, one.severity) << one.id << ": " << one.figure;
        EXPECT_THAT(std::string(flags.begin()->cause.view()), HasSubstr(one.figure));
        for (const auto& sentence : {flags.begin()->cause, flags.begin()->action}) {
            EXPECT_TRUE(sentence.view().ends_with('.')) << "cut: " << sentence.view();
            EXPECT_GT(sentence.view().size(), 15U);
        }
    }
}

TEST(Health, WithoutAHistoryOnlyWhatIsBadInItselfIsFlagged)
{
    HealthFigures now = good();
    now.left.focus = now.right.focus = 30;
    now.fill = 0.2;
    now.hottest_c = 65;
    for (int snapshots = 0; snapshots < 5; ++snapshots)
        EXPECT_THAT(ids(judge_health(history_of(good(), snapshots), now)), IsEmpty()) << snapshots;
    EXPECT_THAT(ids(judge_health(history_of(good(), 5), now)), ElementsAre("blurred", "few_points", "hot"));
    now.left.focus = now.right.focus = 20;
    now.epipolar->median_px = 0.28;
    const HealthFlags flags = judge_health({}, now);
    EXPECT_THAT(ids(flags), ElementsAre("blurred", "drift"));
    EXPECT_THAT(std::string(flags.begin()->cause.view()), HasSubstr("out of focus: 20"));
}

TEST(Health, SixtyPercentOfTheMedianIsTheBorderOfBlur)
{
    HealthHistory history;
    for (const double focus : {90.0, 40.0, 50.0, 60.0, 10.0}) { // median 50
        HealthFigures figures = good();
        figures.left.focus = figures.right.focus = focus;
        history.add(figures);
    }
    HealthFigures now = good();
    now.left.focus = now.right.focus = 30;
    EXPECT_THAT(ids(judge_health(history, now)), IsEmpty());
    now.left.focus = now.right.focus = 29.9;
    EXPECT_THAT(ids(judge_health(history, now)), ElementsAre("blurred"));
}

TEST(Health, OnlyTheNewestTwentyAreUsual)
{
    HealthFigures sharp = good(), now = good();
    sharp.left.focus = sharp.right.focus = 80;
    HealthHistory history = history_of(sharp, 60);
    for (int i = 0; i < 20; ++i)
        history.add(good()); // 52 and 50
    now.left.focus = now.right.focus = 40;
    EXPECT_THAT(ids(judge_health(history, now)), IsEmpty());
    EXPECT_EQ(history.size(), HealthHistory::kMost);
    EXPECT_EQ(history.back(0).left.focus, 52);
    EXPECT_EQ(history.back(63).left.focus, 80);
}

TEST(Health, SlowDriftIsMeasuredAgainstTheFirstSnapshotsNotTheNewest)
{
    HealthHistory history;
    HealthFigures now = good();
    int flagged_at = -1;
    for (int day = 0; day < 400 && flagged_at < 0; ++day) {
        now.epipolar->median_px = -0.2 + 0.001 * day;
        if (!judge_health(history, now).empty())
            flagged_at = day;
        history.add(now);
    }
    EXPECT_NEAR(flagged_at, 254, 2) << "0.25 px from the median of days 0 to 7, while it is only 0.05 px by itself";
    now.calibration_id = "rig-2"; // calibrated again: the old residuals are no measure
    now.epipolar->median_px = 0.06;
    EXPECT_THAT(ids(judge_health(history, now)), IsEmpty());
    history.add(now);
    EXPECT_THAT(std::vector<double>(history.reference_px().begin(), history.reference_px().end()), ElementsAre(0.06));
}

TEST(Health, MissesInARowAreCountedToTheNextSnapshot)
{
    HealthHistory history = history_of(good(), 10);
    HealthFigures miss;
    EXPECT_THAT(ids(judge_health(history, miss)), IsEmpty()) << "one alone";
    history.add(miss);
    const HealthFlags two = judge_health(history, miss);
    ASSERT_THAT(ids(two), ElementsAre("missed"));
    EXPECT_THAT(std::string(two.begin()->cause.view()), HasSubstr("2 slots in a row"));
    for (int i = 0; i < 4; ++i)
        history.add(miss);
    EXPECT_EQ(judge_health(history, miss).begin()->severity, Severity::kAlarm);
    EXPECT_EQ(history.size(), 10U);
    EXPECT_THAT(ids(judge_health(history, good())), IsEmpty());
    history.add(good());
    EXPECT_EQ(history.misses_in_a_row(), 0);
}

TEST(Health, WhatAStartFoundIsToldOnce)
{
    HealthFigures now = good();
    now.repairs.interrupted = 1;
    HealthHistory history = history_of(good(), 3);
    EXPECT_THAT(ids(judge_health(history, now)), ElementsAre("start"));
    history.add(now);
    EXPECT_THAT(ids(judge_health(history, now)), IsEmpty());
}

json record_of(double focus, double median_px)
{
    return {{"sequence", 7},
            {"time", "2026-06-01T12:00:00Z"},
            {"outcome", "done"},
            {"calibration_id", "rig-1"},
            {"shot",
             {{"mean_luma", {{"left", 100.5}, {"right", 101}}},
              {"saturated_share", {{"left", 0.01}, {"right", 0}}},
              {"skew_us", -1500}}},
            {"cloud", {{"points", 50}, {"width", 10}, {"height", 10}}},
            {"clock", {{"trust", "set"}, {"max_error_ms", nullptr}}},
            {"temperatures_c", {{"a", 40.5}, {"b", 51}}},
            {"parameters", {{"burst", {{"most_skew_ms", 10}}}}},
            {"store", {{"interrupted", 2}, {"catalogue_new", true}}},
            {"cameras",
             {{"left", {{"ladder", {{"restarts", 2}, {"gave_up", false}}}}},
              {"right", {{"ladder", {{"reopens", 1}, {"gave_up", true}}}}}}},
            {"health", {{"focus", {{"left", focus}}}, {"epipolar", {{"median_px", median_px}, {"points", 99}}}}}};
}

TEST(HealthRecord, FiguresAreReadFromWhereverTheyStand)
{
    const HealthFigures figures = figures_from_record(record_of(44, -0.125));
    EXPECT_EQ(figures.sequence, 7);
    EXPECT_EQ(figures.began_us, 1780315200000000);
    EXPECT_TRUE(figures.done);
    EXPECT_EQ(figures.left.luma, 100.5);
    EXPECT_EQ(figures.left.saturated, 0.01);
    EXPECT_EQ(figures.left.focus, 44);
    EXPECT_FALSE(figures.right.focus.has_value());
    EXPECT_EQ(figures.skew_ms, -1.5);
    EXPECT_EQ(figures.most_skew_ms, 10);
    EXPECT_EQ(figures.fill, 0.5);
    EXPECT_EQ(figures.hottest_c, 51);
    EXPECT_EQ(figures.clock_trust, ShortText<31>{"set"});
    EXPECT_FALSE(figures.clock_error_s.has_value());
    EXPECT_EQ(figures.shakes, 3);
    EXPECT_TRUE(figures.gave_up);
    EXPECT_EQ(figures.repairs.interrupted, 2);
    EXPECT_TRUE(figures.repairs.catalogue_new);
    ASSERT_TRUE(figures.epipolar.has_value());
    EXPECT_EQ(figures.epipolar->median_px, -0.125);
    EXPECT_EQ(figures.epipolar->points, 99);
}

TEST(HealthRecord, WhatIsWrittenIsReadAgainAndKeepsTheReference)
{
    HealthHistory history;
    json record;
    for (int i = 0; i < 12; ++i) {
        record = record_of(0, 0);
        HealthFigures figures = figures_from_record(record);
        aiming::Focus focus;
        focus.whole = 40 + i;
        add_focus(figures, focus, {});
        add_drift(figures, {.points = 200, .median_px = 0.01 * i, .spread_px = 0.02, .slope_x = -0.01});
        figures.card = {12.5, 800, 1};
        const HealthFlags flags = judge_and_record(record, figures, history);
        EXPECT_EQ(record["health"]["flags"], flags_json(flags));
    }
    const HealthFigures read = figures_from_record(json::parse(record.dump()));
    EXPECT_EQ(read.left.focus, 51);
    EXPECT_FALSE(read.right.focus.has_value());
    EXPECT_NEAR(read.epipolar->median_px, 0.11, 1e-9);
    EXPECT_NEAR(read.epipolar->roll_deg, 0.573, 1e-4);
    EXPECT_EQ(read.card.days_left, 12.5);
    EXPECT_EQ(read.card.in_quarantine, 1);
    std::array<double, HealthHistory::kReference> medians{};
    ASSERT_EQ(reference_from_record(record, medians), 8U);
    EXPECT_NEAR(medians[0], 0, 1e-9);
    EXPECT_NEAR(medians[7], 0.07, 1e-9);
    HealthFigures unknown = read;
    unknown.epipolar.reset();
    add_drift(unknown, {.points = 3});
    EXPECT_FALSE(unknown.epipolar.has_value());
}

TEST(HealthRecord, AnyJsonAtAllGivesFigures)
{
    const char* const kPieces[] = {"null",    "true",       "-1",   "1e308",    "\"\\u001b[2J\"",           "[]", "{}",
                                   "[1,[2]]", "4294967296", "-0.5", "\"done\"", "{\"left\":{\"ladder\":7}}"};
    std::mt19937 random{11};
    for (int round = 0; round < 2000; ++round) {
        json record = record_of(50, 0.1);
        for (int cut = 0; cut < 3; ++cut) {
            const json flat = record.flatten();
            auto entry = flat.begin();
            std::advance(entry, static_cast<std::ptrdiff_t>(random() % flat.size()));
            json::json_pointer place(entry.key());
            if (random() % 2 == 0 && !place.parent_pointer().empty())
                place = place.parent_pointer();
            record[place] = json::parse(kPieces[random() % std::size(kPieces)]);
        }
        const HealthFigures figures = figures_from_record(record);
        EXPECT_TRUE(!figures.fill || (*figures.fill >= 0 && *figures.fill <= 1));
        EXPECT_TRUE(!figures.left.luma || (*figures.left.luma >= 0 && *figures.left.luma <= 255));
        for (const HealthFlag& flag : judge_health(history_of(good(), 20), figures))
            EXPECT_THAT(std::string(flag.cause.view()), testing::Not(HasSubstr("\x1b")));
    }
    for (const char* piece : kPieces)
        EXPECT_FALSE(figures_from_record(json::parse(piece)).done) << piece;
}

} // namespace
} // namespace dicot::app
