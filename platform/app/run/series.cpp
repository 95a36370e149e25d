#include "series.h"

#include "journal.h"

#include "../health/health_record.h"
#include "../stop_request.h"

#include "dicot/base/utc_time.h"
#include "dicot/os/clock.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cinttypes>

namespace dicot::app {
namespace {

constexpr const char* kNotRunning = "dicot was not running: the board was off, or the service stopped";
constexpr const char* kClockSet = "the board's clock was set past it";
constexpr const char* kOverslept = "the board was not awake in time";
constexpr const char* kBusy = "the slot before it was still being worked on";

constexpr std::int64_t kJumpUs = 30'000'000; ///< of the clock, while a slot was taken

void journal_start(const StartReport& report)
{
    if (report.finished + report.interrupted + report.left_over + report.rows_added > 0)
        journal(
            Priority::kNotice,
            "store mended: %d snapshots finished, %d interrupted ones recorded as missed, %d left over, %d rows added",
            report.finished, report.interrupted, report.left_over, report.rows_added);
}

/// "2026-06-01T06:30:00Z (sunrise+30m)"
ShortText<63> words_of(const Slot& slot)
{
    char text[64];
    std::snprintf(text, sizeof text, "%s (%s)", utc_text(slot.due_us).c_str(), slot.why.c_str());
    return text;
}

bool goes_on()
{
    StageWatch::progress();
    return !StopRequest::asked();
}

} // namespace

Status Series::with_store(FunctionRef<Status(Store&, Medium&)> work)
{
    return parts_.in_office([&]() -> Status {
        StoreRules rules = rules_of(parts_.config.output);
        rules.cause = cause_;
        const WrittenStore opened = TRY(parts_.board.open_patiently(rules));
        cause_ = {};
        journal_start(opened.store->start_report());
        newest_us_ = TRY(newest_time(opened.store->catalogue()));
        return work(*opened.store, *opened.medium);
    });
}

Status Series::begin(const ShortText<159>& cause)
{
    cause_ = cause;
    return with_store([&](Store& store, Medium& medium) -> Status {
        history_ = read_history(medium, store.catalogue());
        if (const auto newest = TRY(store.catalogue().newest_planned(parts_.time.earliest_us())))
            last_due_us_ = newest->due_us;
        return {};
    });
}

Plan Series::plan(const ClockReading& clock, FunctionRef<bool(const Slot&)> missed) const
{
    PlanFacts facts;
    facts.last_due_us = last_due_us_;
    facts.now_us = clock.now_us;
    facts.clock_set = clock.trust != ClockTrust::kNotSet;
    facts.late_us = parts_.schedule.late_us;
    facts.taken_us = taken_us_;
    return plan_next(parts_.schedule, parts_.zone, facts, missed);
}

/// The next slot, after a row for each that was missed.
Plan Series::catch_up(const ClockReading& clock)
{
    Plan found = plan(clock, [](const Slot&) { return true; });
    if (found.missed == 0 || !found.next)
        return found;
    journal(Priority::kWarning, "%" PRId64 " slots were missed: %s", found.missed + found.missed_older,
            owed_until_us_ > 0 ? owed_why_.c_str() : missed_why_);
    const std::int64_t until_us = found.next->due_us;
    const Status filed = with_store([&](Store& store, Medium&) { return file_missed(store, clock, until_us); });
    if (!filed.ok()) {
        owe(until_us, missed_why_);
        journal(Priority::kError, "not all of them have a row yet: %s", filed.message());
    }
    return found;
}

/// What is due before `until_us` and has no row gets it later, with this reason.
void Series::owe(std::int64_t until_us, const char* why)
{
    if (owed_until_us_ == 0)
        owed_why_ = why;
    owed_until_us_ = std::max(owed_until_us_, until_us);
}

/// A row for each slot after the newest one that has its row, as far as `until_us`: so none is ever without.
Status Series::file_missed(Store& store, const ClockReading& clock, std::int64_t until_us)
{
    if (!last_due_us_ || clock.trust == ClockTrust::kNotSet)
        return {};
    std::int64_t count = 0;
    SlotWalk counted(parts_.schedule, parts_.zone, *last_due_us_);
    for (auto slot = counted.next(); slot && slot->due_us < until_us; slot = counted.next())
        ++count;
    std::int64_t older = std::max<std::int64_t>(count - kMostMissedRows, 0);
    SlotWalk walk(parts_.schedule, parts_.zone, *last_due_us_);
    for (std::int64_t i = 0; i < older; ++i)
        (void)walk.next();
    for (std::int64_t i = older; i < count; ++i) {
        if (!goes_on())
            return failure(Fault::kTryAgain, "stopped on request; the next start goes on");
        TRY(file_one(store, clock, *walk.next(), older));
        older = 0;
    }
    owed_until_us_ = 0;
    return {};
}

Status Series::file_one(Store& store, const ClockReading& clock, const Slot& slot, std::int64_t older)
{
    SnapshotWords how = how_;
    how.notes = {};
    how.notes.due_us = slot.due_us;
    how.notes.why = slot.why.view();
    const char* const why = slot.due_us < owed_until_us_ ? owed_why_.c_str() : missed_why_;
    const Status reason = older > 0
                              ? failure(Fault::kUnavailable, "%s; so were %" PRId64 " slots before it", why, older)
                              : failure(Fault::kUnavailable, "%s", why);
    bool begun = false;
    const Status filed = record_miss(parts_.config, how, reason, clock, store, begun);
    if (begun)
        last_due_us_ = slot.due_us;
    if (begun && !filed.ok())
        cause_ = ShortText<159>{reason.message()};
    return filed;
}

Woken Series::rest(const Slot& slot)
{
    char text[120];
    std::snprintf(text, sizeof text, "next slot %s", words_of(slot).c_str());
    parts_.watch.status(text);
    StageWatch::leave();
    const bool sleeps = parts_.config.power.between == "suspend";
    if (sleeps)
        parts_.watch.bear(std::max<std::int64_t>(slot.due_us - parts_.time.now(newest_us_).now_us, 0));
    const Woken woken = parts_.time.rest({.due_us = slot.due_us, .slot = 0}, [] { return goes_on(); });
    if (sleeps)
        parts_.watch.bear(0);
    if (!woken.trouble.empty())
        journal(Priority::kWarning, "%s", woken.trouble.c_str());
    if (woken.reason == WakeReason::kClockChanged)
        journal(Priority::kNotice, "the clock was set");
    return woken;
}

void Series::tell(const SnapshotTold& told, const Slot* slot)
{
    const ShortText<63> planned = slot != nullptr ? words_of(*slot) : ShortText<63>{"not planned"};
    for (const std::string& warning : told.warnings)
        journal(Priority::kWarning, "%s: %s", told.folder.c_str(), warning.c_str());
    for (const HealthFlag& flag : told.flags)
        journal(flag.severity == Severity::kAlarm     ? Priority::kError
                : flag.severity == Severity::kWarning ? Priority::kWarning
                                                      : Priority::kNotice,
                "health: %s: %s %s", flag.id, flag.cause.c_str(), flag.action.c_str());
    if (told.status.ok())
        journal(Priority::kInfo, "%s done: %s, %" PRId64 " points", told.folder.c_str(), planned.c_str(),
                told.record["cloud"]["points"].get<std::int64_t>());
    else
        journal(Priority::kError, "%s missed: %s: %s", told.folder.c_str(), planned.c_str(), told.status.message());
    if (!told.stored)
        journal(Priority::kError, "%s: not even the miss could be recorded: the next start will", told.folder.c_str());
}

Status Series::take(const Slot* slot, const Woken& woken)
{
    std::int64_t began_us = 0;
    std::optional<std::int64_t> pair_at_us;
    bool has_row = false;
    if (const Status on = parts_.cameras.on(); !on.ok())
        journal(Priority::kWarning, "%s", on.message());
    const ClockReading clock = parts_.time.now(newest_us_);
    const Status status = with_store([&](Store& store, Medium& medium) -> Status {
        if (slot != nullptr)
            TRY(file_missed(store, clock, slot->due_us));
        began_us = monotonic_us(); // waiting for the store is no warming up
        SnapshotTold told = TRY(
            take_snapshot(parts_.config, words_for(slot, woken, store, medium), parts_.bench, clock, history_, store));
        has_row = true;
        pair_at_us = told.pair_at_us;
        if (!told.stored)
            cause_ = ShortText<159>{told.status.message()};
        tell(told, slot);
        return told.status;
    });
    if (const Status off = parts_.cameras.off(); !off.ok())
        journal(Priority::kNotice, "%s", off.message());
    if (pair_at_us)
        parts_.time.pair_was_ready_after(*pair_at_us - began_us);
    if (!has_row)
        journal(Priority::kError, "%s", status.message());
    if (slot != nullptr) {
        taken_us_ = slot->due_us;
        if (!has_row) {
            owe(slot->due_us + 1, status.message());
            if (!last_due_us_ && clock.trust != ClockTrust::kNotSet)
                last_due_us_ = slot->due_us - 1; // the series begins with it
        } else if (clock.trust != ClockTrust::kNotSet)
            last_due_us_ = slot->due_us;
    }
    newest_us_ = clock.now_us;
    return status;
}

SnapshotWords Series::words_for(const Slot* slot, const Woken& woken, Store& store, Medium& medium) const
{
    SnapshotWords how = how_;
    how.notes = {};
    how.card = card_health(medium, store.catalogue(), rules_of(parts_.config.output).reserve_bytes);
    how.notes.clock_shift_us = parts_.time.shift_us();
    if (slot != nullptr) {
        how.notes.due_us = slot->due_us;
        how.notes.why = slot->why.view();
        how.notes.woken = woken;
        how.notes.begun_us = parts_.time.begin_us(slot->due_us);
    }
    return how;
}

Status Series::run(std::optional<std::int64_t> slots)
{
    Woken woken = parts_.time.begun();
    missed_why_ = kNotRunning;
    while (!StopRequest::asked()) {
        StageWatch::progress();
        const ClockReading clock = parts_.time.now(newest_us_);
        const Plan found = catch_up(clock);
        missed_why_ = kOverslept;
        if (!found.next)
            return failure(Fault::kConfig,
                           "[schedule] names no slot within a year: give schedule.at or schedule.every");
        if (!found.late && clock.now_us < parts_.time.begin_us(found.next->due_us)) {
            const Woken rested = rest(*found.next);
            if (rested.reason != WakeReason::kTime || rested.way != Between::kIdle)
                woken = rested; // of a board that was idle for the last minutes it is told what woke it before
            if (rested.reason == WakeReason::kClockChanged)
                missed_why_ = kClockSet;
            if (StopRequest::asked() || parts_.time.now(newest_us_).now_us < parts_.time.begin_us(found.next->due_us) ||
                rested.reason == WakeReason::kClockChanged)
                continue; // the plan may be another one by now
        }
        const std::int64_t began_us = monotonic_us();
        const std::int64_t showed_us = parts_.time.now(newest_us_).now_us;
        (void)take(&*found.next, woken);
        woken = {};
        const std::int64_t jumped_us = parts_.time.now(newest_us_).now_us - showed_us - (monotonic_us() - began_us);
        missed_why_ = jumped_us > kJumpUs ? kClockSet : kBusy;
        if (!slots) // a later start may find what is missing now; a rehearsal goes on as it began
            TRY(parts_.bench.status());
        if (slots && --*slots <= 0)
            return {};
    }
    return {};
}

Status Series::once()
{
    const Woken woken = parts_.time.begun();
    missed_why_ = kNotRunning;
    const Plan found = catch_up(parts_.time.now(newest_us_));
    return take(found.late && found.next ? &*found.next : nullptr, woken);
}

} // namespace dicot::app
