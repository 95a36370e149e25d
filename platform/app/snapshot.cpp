#include "snapshot.h"

#include "cameras/shot_record.h"
#include "cloud_report.h"
#include "health/health_record.h"
#include "sealed_heap.h"
#include "store/slot_record.h"

#include "dicot/base/printable.h"
#include "dicot/base/utc_time.h"
#include "dicot/os/process_memory.h"
#include "dicot/os/stage_watch.h"
#include "dicot/record/record.h"

#include <span>

namespace dicot::app {
namespace {

constexpr int kStoreSeconds = 120; ///< a card that takes longer is broken

CloudWords cloud_words(const Config& config)
{
    CloudWords words;
    words.rig = config.rig.file;
    words.near_mm = config.rig.near_mm;
    words.far_mm = config.rig.far_mm;
    words.match.method = config.matching.method;
    words.match.cost = config.matching.cost;
    words.match.cpu = config.matching.cpu;
    words.match.threads = config.matching.threads;
    words.match.options.window = config.matching.window;
    words.match.options.gamma_color = config.matching.gamma_color;
    words.match.options.gamma_space = config.matching.gamma_space;
    return words;
}

struct Size
{
    int width, height;
};

/// Recorded pictures alone have a size of their own.
Result<Size> picture_size(const Config& config)
{
    if (config.cameras.left.by != BoundBy::kReplay)
        return Size{config.cameras.width, config.cameras.height};
    const RigStream recorded = TRY(RigStream::open(config, Pace::kAtOnce));
    return Size{recorded.width(), recorded.height()};
}

/// A store's snapshot as a shelf.
class StoreShelf final : public FileShelf
{
public:
    explicit StoreShelf(Store& store) : store_(store) {}
    Status put(const char* name, FunctionRef<Status(ByteSink&)> fill) override { return store_.add(name, fill); }

private:
    Store& store_;
};

Status shoot(const Config& config, const SnapshotWords& words, SnapshotBench& bench, const ClockReading& clock,
             Store& store, SnapshotTold& told, std::optional<ShotFigures>& seen)
{
    CloudWork& work = *bench.work;
    work.stage_bound_us = std::int64_t{config.watchdog.stage_s} * 1'000'000;
    StageWatch::enter("open the cameras", work.stage_bound_us);
    RigStream rig = TRY(RigStream::open(config, Pace::kAtOnce));
    if (rig.width() != bench.plan.rig.width || rig.height() != bench.plan.rig.height)
        return failure(Fault::kBadData, "the cameras' pictures are %d x %d px, and were %d x %d a moment ago",
                       rig.width(), rig.height(), bench.plan.rig.width, bench.plan.rig.height);
    StoreShelf shelf(store);
    Shot shot(rig, config, words.raw ? &shelf : nullptr, words.notes.clock_shift_us);
    PictureNames names;
    names.left = "left.jpg";
    if (words.preview)
        names.preview = "preview.png";
    CloudMeta meta = bench.plan.meta;
    meta.device_id = std::string_view{words.device};
    meta.clock_trust = name_of(clock.trust);
    meta.sequence = store.sequence();
    Status status;
    {
        const SealedHeap sealed;
        status = [&]() -> Status {
            TRY(work.see(shot, names, shelf, false));
            meta.captured_at = utc_text(shot.figures().taken_us).view();
            meta.skew_us = shot.figures().burst.skew_us;
            TRY(work.encode(meta));
            TRY(work.write_cloud("cloud.drc", shelf));
            return work.write_preview(names, shelf);
        }();
    }
    told.record["cameras"] = cameras_record(rig);
    if (shot.figures().burst.used > 0) {
        seen = shot.figures();
        told.pair_at_us = seen->ready_us;
        told.record["shot"] = shot_record(shot.figures());
        told.warnings = shot_warnings(rig, shot.figures());
    }
    TRY(status);
    told.record["cloud"] = cloud_report(work, config.matching.method, TRY(process_memory()).peak_bytes);
    told.record["calibration_id"] = bench.plan.meta.calibration_id.c_str();
    return {};
}

/// What is wrong with the rig, by what was measured and by the slots before.
void judge(const SnapshotWords& words, const SnapshotBench* bench, const ShotFigures* shot, HealthHistory& history,
           SnapshotTold& told)
{
    told.record["outcome"] = told.status.ok() ? "done" : "missed";
    HealthFigures figures = figures_from_record(told.record);
    if (shot != nullptr)
        add_focus(figures, shot->left_focus, shot->right_focus);
    if (bench != nullptr && told.status.ok())
        add_drift(figures, bench->work->drift());
    figures.card = words.card;
    told.flags = judge_and_record(told.record, figures, history);
}

/// The last file, and the commit.
Status store_it(SnapshotTold& told, const ClockReading& clock, Store& store)
{
    StageWatch::enter("store", std::int64_t{kStoreSeconds} * 1'000'000);
    const bool done = told.status.ok();
    told.record["outcome"] = done ? "done" : "missed";
    told.record["reason"] = done ? nlohmann::json() : nlohmann::json(told.status.message());
    told.record["warnings"] = told.warnings;
    files_into(told.record, store);
    const std::string text = text_of_record(told.record) + "\n";
    TRY(store.add("record.json", [&](ByteSink& sink) { return sink.write(std::as_bytes(std::span{text})); }));
    SlotOutcome outcome;
    outcome.done = done;
    outcome.reason = printable<outcome.reason.kCapacity>(told.status.message()); // as the record's reader has it
    outcome.clock_trust = name_of(clock.trust);
    outcome.points = done ? told.record["cloud"]["points"].get<std::int64_t>() : 0;
    return store.commit(outcome);
}

/// The number, and what is known of the slot before anything is done.
Result<SnapshotTold> begin(const Config& config, const SnapshotWords& words, const ClockReading& clock, Store& store)
{
    const std::optional<std::int64_t> due_us = words.notes.due_us;
    TRY(store.begin({.began_us = clock.now_us, .due_us = due_us}));
    StageWatch::slot(static_cast<std::uint64_t>(store.sequence()), due_us.value_or(0));
    SnapshotTold told;
    told.folder = store.folder();
    told.record = {{"format", kRecordFormat},
                   {"software", "dicot " DICOT_VERSION},
                   {"sequence", store.sequence()},
                   {"device", words.device},
                   {"time", utc_text(clock.now_us).view()},
                   {"due", due_us ? nlohmann::json(utc_text(*due_us).view()) : nlohmann::json()},
                   {"source", words.source},
                   {"clock", clock_record(clock)},
                   {"temperatures_c", temperatures_record()},
                   {"parameters", parameters_record(config)},
                   {"store", start_record(store.start_report())}};
    if (due_us)
        told.record["plan"] = plan_record(words.notes);
    return told;
}

} // namespace

std::string text_of_record(const nlohmann::json& record)
{
    return record.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

Result<std::unique_ptr<SnapshotBench>> SnapshotBench::make(const Config& config)
{
    const Size size = TRY(picture_size(config));
    auto bench = std::make_unique<SnapshotBench>();
    bench->plan = TRY(make_cloud_plan(cloud_words(config), size.width, size.height, "the cameras' picture"));
    bench->work = TRY(CloudWork::make(bench->plan, Shot::scratch_bytes(size.width, size.height)));
    return bench;
}

Result<SnapshotTold> take_snapshot(const Config& config, const SnapshotWords& words,
                                   const Result<std::unique_ptr<SnapshotBench>>& bench, const ClockReading& clock,
                                   HealthHistory& history, Store& store)
{
    SnapshotTold told = TRY(begin(config, words, clock, store));
    std::optional<ShotFigures> seen;
    told.status = store.make_room();
    if (told.status.ok())
        told.status = bench.status();
    if (told.status.ok())
        told.status = shoot(config, words, *bench.value(), clock, store, told, seen);
    if (const auto overran = StageWatch::what_overran(); !told.status.ok() && !overran.empty())
        told.status = failure(Fault::kUnavailable, "%s", overran.c_str());
    told.record["memory"] = memory_record(bench.ok() ? bench.value()->work->budget().total() : 0);
    Status stored;
    const auto judged = [&] {
        HealthHistory after = history;
        judge(words, bench.ok() ? bench.value().get() : nullptr, seen ? &*seen : nullptr, after, told);
        return after;
    };
    HealthHistory after = judged();
    if (told.status.ok()) {
        stored = store_it(told, clock, store);
        told.status = stored; // what cannot be stored was not done
    }
    if (!told.status.ok()) {
        told.record.erase("cloud"); // taken back as its file is
        told.record.erase("calibration_id");
        after = judged();
        stored = store.take_back();
        if (stored.ok())
            stored = store_it(told, clock, store);
    }
    told.stored = stored.ok();
    history = after;
    return told;
}

Status record_miss(const Config& config, const SnapshotWords& how, const Status& reason, const ClockReading& clock,
                   Store& store, bool& begun)
{
    begun = false;
    SnapshotTold told = TRY(begin(config, how, clock, store));
    begun = true;
    told.status = reason;
    return store_it(told, clock, store);
}

const char* source_of(const Config& config, bool is_drawn) noexcept
{
    return is_drawn ? "drawn pictures" : config.cameras.left.by == BoundBy::kReplay ? "recorded pictures" : "cameras";
}

} // namespace dicot::app
