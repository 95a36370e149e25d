// Slot after slot, for months: plan, rest, take, store, and never an end because of one that failed.
#pragma once

#include "timekeeper.h"

#include "../config/config.h"
#include "../health/health_history.h"
#include "../snapshot.h"
#include "../store/board_store.h"
#include "dicot/os/stage_watch.h"
#include "dicot/power/cameras_power.h"
#include "dicot/schedule/plan.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace dicot::app {

/// Everything that a series is made of, taken before it begins. All of it is borrowed.
struct SeriesParts
{
    const Config& config;
    const Schedule& schedule;
    const TimeZone& zone;
    const BoardStore& board;
    const Result<std::unique_ptr<SnapshotBench>>& bench;
    Timekeeper& time;
    CamerasPower& cameras;
    StageWatch& watch;
    /// Memory for the work of one slot: what is made in there is gone afterwards.
    FunctionRef<Status(FunctionRef<Status()>)> in_office;
};

class Series
{
public:
    Series(const SeriesParts& parts, SnapshotWords how) : parts_(parts), how_(std::move(how)) {}

    /// What the store knows of the slots before: which was planned last, how healthy they were. `cause`: why a
    /// snapshot that is found begun was not finished. Errors: those of BoardStore::open_patiently() and of the
    /// catalogue.
    Status begin(const ShortText<159>& cause);

    /// Until somebody wants an end, or `slots` were taken. Failures are recorded, or told, and the next slot comes.
    /// Fault::kConfig: the schedule names no slot. Without `slots` also a fault of the bench ends it, after a slot that
    /// was missed for it: whoever starts it again may find it mended.
    Status run(std::optional<std::int64_t> slots);
    /// The slot that is due now; if none is, a snapshot that nobody planned. Its status.
    Status once();

private:
    Status with_store(FunctionRef<Status(Store&, Medium&)> work);
    Plan plan(const ClockReading& clock, FunctionRef<bool(const Slot&)> missed) const;
    Plan catch_up(const ClockReading& clock);
    void owe(std::int64_t until_us, const char* why);
    Status file_missed(Store& store, const ClockReading& clock, std::int64_t until_us);
    Status file_one(Store& store, const ClockReading& clock, const Slot& slot, std::int64_t older);
    SnapshotWords words_for(const Slot* slot, const Woken& woken, Store& store, Medium& medium) const;
    Status take(const Slot* slot, const Woken& woken);
    void tell(const SnapshotTold& told, const Slot* slot);
    Woken rest(const Slot& slot);

    SeriesParts parts_;
    SnapshotWords how_;
    HealthHistory history_;
    ShortText<159> cause_;
    std::optional<std::int64_t> last_due_us_; ///< as PlanFacts has it
    std::optional<std::int64_t> taken_us_;    ///< as PlanFacts has it
    std::optional<std::int64_t> newest_us_;   ///< a time that is over
    std::int64_t owed_until_us_ = 0;          ///< slots before that have no row though they should; 0: all have
    ShortText<159> owed_why_;                 ///< what kept the first of them from it
    const char* missed_why_ = "";             ///< what came between, should a slot have been missed
};

} // namespace dicot::app
