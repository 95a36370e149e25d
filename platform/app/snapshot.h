// One slot of a series: from the cameras into the store, or a written reason why not.
#pragma once

#include "cloud_work.h"
#include "config/config.h"
#include "health/health_history.h"
#include "health/judge_health.h"
#include "run/slot_notes.h"

#include "dicot/os/clock_trust.h"
#include "dicot/store/store.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dicot::app {

/// Tables, threads and memory of a snapshot, all taken before anything begins.
struct SnapshotBench
{
    CloudPlan plan;
    std::unique_ptr<CloudWork> work;

    /// Fault::kConfig, kUsage: the configuration asks for what cannot be. Errors: those of make_cloud_plan() and
    /// CloudWork::make(); of recorded pictures, those of RigStream::open().
    static Result<std::unique_ptr<SnapshotBench>> make(const Config& config);
};

struct SnapshotWords
{
    bool raw = false;
    bool preview = false;
    std::string device; ///< is_device_name()
    const char* source = "cameras";
    SlotNotes notes;
    HealthCard card; ///< before it begins
};

/// "drawn pictures", "recorded pictures", "cameras".
const char* source_of(const Config& config, bool is_drawn) noexcept;

/// What a slot came to.
struct SnapshotTold
{
    nlohmann::json record; ///< as record.json has it
    std::vector<std::string> warnings;
    std::string folder;                     ///< from the store's folder
    Status status;                          ///< ok, or why it was missed
    bool stored = false;                    ///< a miss too: its record is in its place
    HealthFlags flags;                      ///< what is wrong with the rig, as the record has it
    std::optional<std::int64_t> pair_at_us; ///< monotonic_us() when the cameras had given their pair
};

/// Takes the next number, shoots, and commits what there is: everything, or the record of a miss alone. A fault of
/// `bench` is a miss as well. The slot is judged by those before it, and added to `history`. Error: the store gives no
/// number.
Result<SnapshotTold> take_snapshot(const Config& config, const SnapshotWords& words,
                                   const Result<std::unique_ptr<SnapshotBench>>& bench, const ClockReading& clock,
                                   HealthHistory& history, Store& store);

/// Takes the next number for a slot that nobody could take, and commits the record of a miss, with `reason`. Nothing
/// is judged. `begun`: the slot has its number, so its row will come, if not now then at the next start. Errors: those
/// of Store::begin(), add() and commit().
Status record_miss(const Config& config, const SnapshotWords& how, const Status& reason, const ClockReading& clock,
                   Store& store, bool& begun);

/// Paths and names may hold bytes that are no UTF-8.
std::string text_of_record(const nlohmann::json& record);

} // namespace dicot::app
