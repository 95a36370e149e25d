#include "dicot/base/utc_time.h"
#include "dicot/os/heap_gate.h"
#include "dicot/schedule/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::int64_t kMinuteUs = 60'000'000;
constexpr std::int64_t kDayUs = 1440 * kMinuteUs;

Schedule every(const char* interval)
{
    ScheduleConfig words;
    words.every = interval;
    return make_schedule(words).value();
}

std::int64_t utc(const std::string& text)
{
    return parse_utc_text(text).value();
}

/// A plan in UTC, as "2026-06-01T12:00:00Z", and "late".
struct Told
{
    Plan plan;
    std::string next;
    std::vector<std::string> missed;
};

Told plan(const Schedule& schedule, const PlanFacts& facts)
{
    Told told;
    told.plan = plan_next(schedule, TimeZone{}, facts, [&told](const Slot& slot) {
        told.missed.emplace_back(utc_text(slot.due_us).c_str());
        return true;
    });
    if (told.plan.next)
        told.next = std::string{utc_text(told.plan.next->due_us).c_str()} + (told.plan.late ? " late" : "");
    EXPECT_EQ(told.plan.missed, static_cast<std::int64_t>(told.missed.size()));
    return told;
}

PlanFacts facts(const char* last, const char* now, int late_min = 15, bool set = true)
{
    PlanFacts told{{}, utc(now), set, late_min * kMinuteUs};
    if (*last != '\0')
        told.last_due_us = utc(last);
    return told;
}

TEST(Plan, TheFirstStartEverMissesNothing)
{
    const Told told = plan(every("2h"), facts("", "2026-06-01T11:00:00Z"));
    EXPECT_EQ(told.next, "2026-06-01T12:00:00Z");
    EXPECT_THAT(told.missed, IsEmpty());
}

TEST(Plan, ASlotThatWasTakenIsFollowedByTheNextOne)
{
    const Told told = plan(every("2h"), facts("2026-06-01T10:00:00Z", "2026-06-01T10:00:20Z"));
    EXPECT_EQ(told.next, "2026-06-01T12:00:00Z");
    EXPECT_THAT(told.missed, IsEmpty());
}

TEST(Plan, ALateSlotIsTakenAsLongAsItMayBe)
{
    EXPECT_EQ(plan(every("2h"), facts("2026-06-01T10:00:00Z", "2026-06-01T12:00:00Z")).next,
              "2026-06-01T12:00:00Z late");
    EXPECT_EQ(plan(every("2h"), facts("2026-06-01T10:00:00Z", "2026-06-01T12:15:00Z")).next,
              "2026-06-01T12:00:00Z late");
    const Told over = plan(every("2h"), facts("2026-06-01T10:00:00Z", "2026-06-01T12:15:01Z"));
    EXPECT_EQ(over.next, "2026-06-01T14:00:00Z");
    EXPECT_THAT(over.missed, ElementsAre("2026-06-01T12:00:00Z"));
}

TEST(Plan, OfSeveralLateSlotsTheNewestIsTaken)
{
    const Told told = plan(every("5m"), facts("2026-06-01T10:00:00Z", "2026-06-01T10:16:00Z"));
    EXPECT_EQ(told.next, "2026-06-01T10:15:00Z late");
    EXPECT_THAT(told.missed, ElementsAre("2026-06-01T10:05:00Z", "2026-06-01T10:10:00Z"));
}

TEST(Plan, AJumpForwardMissesWhatIsBetween)
{
    const Told told = plan(every("12h"), facts("2026-06-01T12:00:00Z", "2026-06-03T06:00:00Z"));
    EXPECT_EQ(told.next, "2026-06-03T12:00:00Z");
    EXPECT_THAT(told.missed, ElementsAre("2026-06-02T00:00:00Z", "2026-06-02T12:00:00Z", "2026-06-03T00:00:00Z"));
}

TEST(Plan, AClockOf1970KeepsTheCadenceAndMissesNothing)
{
    const Told told = plan(every("2h"), facts("2026-06-01T12:00:00Z", "1970-01-01T00:03:00Z", 15, false));
    EXPECT_EQ(told.next, "1970-01-01T02:00:00Z");
    EXPECT_THAT(told.missed, IsEmpty());
    const Told set_again = plan(every("12h"), facts("2026-06-01T12:00:00Z", "2026-06-02T12:01:00Z"));
    EXPECT_EQ(set_again.next, "2026-06-02T12:00:00Z late");
    EXPECT_THAT(set_again.missed, ElementsAre("2026-06-02T00:00:00Z"));
}

TEST(Plan, ASmallStepBackDoesNothingAgain)
{
    for (const char* now : {"2026-06-01T11:59:59Z", "2026-06-01T11:45:00Z"}) {
        const Told told = plan(every("5m"), facts("2026-06-01T12:00:00Z", now));
        EXPECT_EQ(told.next, "2026-06-01T12:05:00Z") << now;
        EXPECT_THAT(told.missed, IsEmpty());
    }
}

TEST(Plan, ALargeStepBackDoesNotSilenceTheSeries)
{
    EXPECT_EQ(plan(every("5m"), facts("2026-06-01T12:00:00Z", "2026-06-01T11:44:59Z")).next, "2026-06-01T11:45:00Z");
    const Told year = plan(every("2h"), facts("2027-06-01T12:00:00Z", "2026-06-01T11:00:00Z"));
    EXPECT_EQ(year.next, "2026-06-01T12:00:00Z");
    EXPECT_THAT(year.missed, IsEmpty());
}

TEST(Plan, NoDueIsTakenTwiceInARowHoweverTheClockSteps)
{
    EXPECT_EQ(plan(every("24h"), facts("2026-06-02T00:00:00Z", "2026-06-01T01:00:00Z")).next, "2026-06-03T00:00:00Z");
    PlanFacts unset = facts("", "1970-01-01T01:59:58Z", 15, false);
    unset.taken_us = utc("1970-01-01T02:00:00Z");
    EXPECT_EQ(plan(every("2h"), unset).next, "1970-01-01T04:00:00Z");
    PlanFacts just_set = facts("2026-06-01T10:00:00Z", "2026-06-01T12:01:00Z");
    just_set.taken_us = utc("2026-06-01T12:00:00Z"); // while the clock was not believed
    const Told told = plan(every("2h"), just_set);
    EXPECT_EQ(told.next, "2026-06-01T14:00:00Z");
    EXPECT_THAT(told.missed, IsEmpty());
}

TEST(Plan, TheNewestRowsAreKeptAndTheRestIsCounted)
{
    // A year of minutes: 525,600, and the last one is late.
    const Told told = plan(every("1m"), facts("2026-01-01T00:00:00Z", "2027-01-01T00:00:00Z"));
    EXPECT_EQ(told.next, "2027-01-01T00:00:00Z late");
    EXPECT_EQ(told.plan.missed, kMostMissedRows);
    EXPECT_EQ(told.plan.missed_older, 525'600 - 1 - kMostMissedRows);
    EXPECT_EQ(told.missed.back(), "2026-12-31T23:59:00Z");
    EXPECT_EQ(told.missed.front(), "2026-12-30T14:40:00Z");
}

TEST(Plan, AVisitorMayStopAndThePlanIsTheSame)
{
    int calls = 0;
    const Plan stopped = plan_next(every("1h"), TimeZone{}, facts("2026-06-01T00:00:00Z", "2026-06-01T10:30:00Z"),
                                   [&calls](const Slot&) { return ++calls < 3; });
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(stopped.missed, 2);
    EXPECT_FALSE(stopped.told_all);
    EXPECT_EQ(stopped.next->due_us, utc("2026-06-01T11:00:00Z"));
}

TEST(Plan, AnEmptyScheduleHasNoNext)
{
    EXPECT_EQ(plan(Schedule{}, facts("2026-06-01T00:00:00Z", "2026-06-02T00:00:00Z")).next, "");
}

TEST(Plan, TakesNothingFromTheHeap)
{
    if (!heap_gate::replaces_operator_new())
        GTEST_SKIP() << "the sanitizer has its own operator new";
    ScheduleConfig words;
    words.at = {"06:30", "sunrise+30m", "sunset"};
    words.every = "5m";
    words.latitude = 69.65;
    words.longitude = 18.96;
    const Schedule schedule = make_schedule(words).value();
    const PlanFacts year = facts("2026-01-01T00:00:00Z", "2027-01-01T00:00:00Z");
    std::int64_t rows = 0;
    heap_gate::seal(heap_gate::Breach::kCount);
    const Result<TimeZone> zone = TimeZone::open("Europe/Berlin", DICOT_SCHEDULE_DATA "/zoneinfo");
    const Plan plan = plan_next(schedule, zone.value(), year, [&rows](const Slot&) { return ++rows > 0; });
    const std::uint64_t breaches = heap_gate::breaches();
    heap_gate::unseal();
    EXPECT_EQ(breaches, 0U);
    EXPECT_EQ(rows, kMostMissedRows);
    EXPECT_TRUE(plan.next.has_value());
}

/// A board with a clock that nobody can rely on. Dues are the multiples of the interval, which needs no schedule.
class Board
{
public:
    Board(std::uint32_t seed, std::int64_t step_us, int late_min)
        : random_(seed), step_us_(step_us), late_us_(late_min * kMinuteUs)
    {
        schedule_ = every((std::to_string(step_us / kMinuteUs) + "m").c_str());
    }

    void run(int turns)
    {
        for (int turn = 0; turn < turns && !testing::Test::HasFailure(); ++turn)
            live();
    }

    int taken = 0, missed = 0, eras = 0;

private:
    std::int64_t any(std::int64_t least, std::int64_t most)
    {
        return std::uniform_int_distribution<std::int64_t>{least, most}(random_);
    }

    void live()
    {
        PlanFacts facts{last_due_us_, now_us_, set_, late_us_};
        facts.taken_us = taken_us_;
        begin_era_if_needed();
        std::int64_t before = INT64_MIN;
        std::vector<std::int64_t> rows;
        const Plan plan = plan_next(schedule_, TimeZone{}, facts, [&](const Slot& slot) {
            EXPECT_GT(slot.due_us, before);
            before = slot.due_us;
            rows.push_back(slot.due_us);
            return true;
        });
        ASSERT_TRUE(plan.next.has_value()) << "the series ends";
        const std::int64_t due = plan.next->due_us;
        EXPECT_EQ(due % step_us_, 0);
        EXPECT_NE(due, taken_us_);
        EXPECT_LE(due, now_us_ + kSmallStepBackUs + 2 * step_us_) << "the series falls silent";
        EXPECT_EQ(plan.late, due <= now_us_);
        EXPECT_GE(due, now_us_ - late_us_);
        EXPECT_TRUE(set_ || rows.empty());
        EXPECT_EQ(plan.missed_older, 0);
        for (const std::int64_t row : rows)
            judge(row);
        if (!rows.empty())
            last_due_us_ = rows.back();
        missed += static_cast<int>(rows.size());
        if (set_)
            expect_verdicts(due);

        if (any(0, 9) == 0 && !plan.late) { // something happens before it is due: it is planned anew
            now_us_ += any(0, std::max(std::int64_t{0}, due - now_us_ - 1));
            disturb();
            return;
        }
        now_us_ = std::max(now_us_, due) + any(1, 2 * kMinuteUs);
        taken_us_ = due;
        ++taken;
        if (set_) {
            judge(due);
            last_due_us_ = due;
        }
        if (any(0, 4) == 0)
            disturb();
    }

    void disturb()
    {
        switch (any(0, 6)) {
        case 0: // the power was away
            now_us_ += any(0, 20 * step_us_);
            taken_us_.reset();
            break;
        case 1:
            now_us_ += any(0, 30 * step_us_);
            break;
        case 2:
            now_us_ -= any(0, kSmallStepBackUs);
            break;
        case 3:
            now_us_ -= any(0, 30 * step_us_);
            break;
        case 4: // ahead by a year, and back some day
            now_us_ += set_ ? any(0, 900 * step_us_) : 0;
            break;
        case 5:
            if (set_)
                kept_us_ = now_us_;
            set_ = false;
            now_us_ = any(0, 3 * step_us_);
            break;
        default:
            if (!set_)
                now_us_ = kept_us_ + any(-2 * step_us_, 50 * step_us_);
            set_ = true;
        }
    }

    /// From where on every due has its one verdict.
    struct Era
    {
        std::int64_t from_us = 0;
        std::map<std::int64_t, int> verdicts;
    };

    /// A clock that was set back begins a new one, with its first row.
    void begin_era_if_needed()
    {
        next_era_.reset();
        const bool back = last_due_us_ && *last_due_us_ - now_us_ > kSmallStepBackUs;
        if (!set_ || (last_due_us_ && !back))
            return;
        next_era_ = Era{now_us_, {}};
        for (const std::optional<std::int64_t>& done : {last_due_us_, taken_us_})
            if (done && *done > now_us_ && *done - now_us_ <= step_us_) // it would be the next one, and is done
                next_era_->verdicts[*done] = 1;
    }

    void judge(std::int64_t due)
    {
        if (next_era_) {
            era_ = *std::move(next_era_);
            next_era_.reset();
            ++eras;
        }
        EXPECT_EQ(++era_.verdicts[due], 1) << utc_text(due).c_str();
    }

    /// Each due of this era that is over has one, but for that which is taken now.
    void expect_verdicts(std::int64_t next)
    {
        const Era& era = next_era_ ? *next_era_ : era_;
        for (std::int64_t due = (era.from_us / step_us_ + 1) * step_us_; due <= now_us_; due += step_us_)
            if (due != next && due != taken_us_) {
                EXPECT_EQ(era.verdicts.count(due), 1U) << utc_text(due).c_str();
            }
        EXPECT_EQ(era.verdicts.count(next), 0U) << utc_text(next).c_str();
    }

    std::mt19937 random_;
    Schedule schedule_;
    std::int64_t step_us_, late_us_;
    std::int64_t now_us_ = 20'000 * kDayUs;
    std::int64_t kept_us_ = now_us_;
    bool set_ = true;
    std::optional<std::int64_t> last_due_us_, taken_us_;
    Era era_;
    std::optional<Era> next_era_;
};

TEST(Plan, WhateverTheClockDoesEveryDueHasOneVerdict)
{
    int taken = 0;
    int missed = 0;
    for (std::uint32_t seed = 1; seed <= 60 && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        constexpr std::int64_t kSteps[] = {1, 5, 20, 30, 120, 720};
        Board board(seed, kSteps[seed % 6] * kMinuteUs, static_cast<int>(seed % 4) * 10);
        board.run(300);
        EXPECT_GT(board.eras, 1);
        taken += board.taken;
        missed += board.missed;
    }
    EXPECT_GT(taken, 10'000);
    EXPECT_GT(missed, 10'000);
}

} // namespace
} // namespace dicot::app
