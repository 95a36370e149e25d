// dicot run: what stays beside the plants.
#include "commands.h"
#include "config_words.h"
#include "output_folder.h"
#include "run/board_time.h"
#include "run/journal.h"
#include "run/run_memory.h"
#include "run/series.h"
#include "run/told_time.h"
#include "stop_request.h"
#include "usb/gadget_child.h"

#include "dicot/base/utc_time.h"
#include "dicot/power/power_rules.h"

#include <chrono>
#include <memory>

namespace dicot::app {
namespace {

constexpr std::int64_t kMostRehearsed = 100'000;

struct RunWords
{
    ConfigWords config;
    std::string root;
    bool once = false;
    std::int64_t rehearsed = 0; ///< 0: this is no rehearsal
    std::string from;
};

/// Where a start finds how the last one ended; without it a series runs as well, and knows less.
std::string state_folder(const Config& config)
{
    const Status made = make_folder(config.run.state);
    if (made.ok())
        return config.run.state;
    journal(Priority::kWarning, "%s: how long cameras warm up and why a start was needed is not kept (run.state)",
            made.message());
    return {};
}

ShortText<159> cause_of(const StageWatch& watch)
{
    if (!watch.previous() || watch.previous()->stage.empty())
        return {};
    return words_of(*watch.previous()).view();
}

/// Fault::kTryAgain: another dicot run has this state. Whatever else does not work is told, and done without.
Status open_watch(StageWatch& watch, const Config& config, const std::string& state)
{
    const std::string file = state.empty() ? "" : state + "/stage";
    StageWatchRules rules;
    rules.device = config.watchdog.device.c_str();
    rules.stage_file = file.c_str();
    const Status opened = watch.open(rules);
    if (opened.fault() == Fault::kTryAgain)
        return opened;
    if (!opened.ok())
        journal(Priority::kWarning, "%s", opened.message());
    if (!watch.device_trouble().ok())
        journal(Priority::kWarning, "%s", watch.device_trouble().message());
    return {};
}

Result<std::int64_t> told_from(const RunWords& words)
{
    if (words.from.empty())
        return std::chrono::duration_cast<std::chrono::microseconds>(
                   std::chrono::system_clock::now().time_since_epoch())
            .count();
    if (const auto from = parse_utc_text(words.from))
        return *from;
    return failure(Fault::kUsage, "--from is %s: give a time as 2026-06-01T06:00:00Z", words.from.c_str());
}

Status check(const RunWords& words, const Config& config, const Schedule& schedule)
{
    if (words.rehearsed > 0 && config.cameras.left.by != BoundBy::kReplay)
        return failure(Fault::kUsage, "a rehearsal needs recorded pictures: give cameras.left = \"replay:FOLDER\"");
    if (words.rehearsed == 0 && !words.from.empty())
        return failure(Fault::kUsage, "--from goes with --rehearse: the time of the board cannot be told");
    if (!words.once && schedule.empty())
        return failure(Fault::kConfig, "[schedule] names no time: give schedule.at or schedule.every, or --once");
    return {};
}

/// Everything that the series will ever take. Without a bench every slot is a miss, which takes none for clouds.
Result<std::unique_ptr<RunMemory>> carve_memory(const Config& config, const BareProcess& bare,
                                                const Result<std::unique_ptr<SnapshotBench>>& bench)
{
    CameraMemory cameras;
    ProcessBudget clouds;
    if (bench.ok()) {
        cameras = TRY(CameraMemory::measure(config));
        clouds = bench.value()->work->budget();
    }
    const RunBudget budget =
        TRY(run_budget(config, bare, cameras, clouds, bench.ok() ? bench.value()->plan.threads : 1));
    std::unique_ptr<RunMemory> memory = TRY(RunMemory::carve(budget));
    if (const Status locked = config.run.lock_memory ? RunMemory::lock_in_ram(budget) : Status{}; !locked.ok())
        journal(Priority::kNotice, "%s", locked.message());
    return memory;
}

/// Ports that are switched off are those that the configuration names.
void use_ports(CamerasPower& cameras, const Config& config)
{
    const CameraBinding& left = config.cameras.left;
    const CameraBinding& right = config.cameras.right;
    if (left.by != BoundBy::kPort || right.by != BoundBy::kPort)
        return;
    if (const Status used = cameras.use(left.what.c_str(), right.what.c_str()); !used.ok())
        journal(Priority::kWarning, "%s", used.message());
}

/// The clouds on the cable are a process of their own: what a computer may do there never meets the series.
void show_to_computers(GadgetChild& child, const RunWords& words, const std::string& config_file)
{
    std::vector<std::string> said{"dicot", "gadget", "up"};
    if (!config_file.empty())
        said.insert(said.end(), {"--config", config_file});
    if (!words.root.empty())
        said.insert(said.end(), {"--output", words.root});
    if (const Status started = child.start(std::move(said)); !started.ok())
        journal(Priority::kWarning, "%s", started.message());
}

Status go(const RunWords& words, const LoadedConfig& loaded, const Schedule& schedule, const TimeZone& zone)
{
    const Config& config = loaded.config;
    RunMemory::keep_address_space_known();
    const BareProcess bare = TRY(BareProcess::measure());
    const bool told = words.rehearsed > 0;
    Config used = config;
    used.run.state = told ? std::string{} : state_folder(config);
    std::unique_ptr<Timekeeper> time;
    if (told)
        time = std::make_unique<ToldTime>(TRY(told_from(words)));
    else
        time = std::make_unique<BoardTime>(used);
    const StopRequest stop;
    StageWatch watch;
    TRY(open_watch(watch, config, used.run.state));
    const Result<std::unique_ptr<SnapshotBench>> bench = SnapshotBench::make(config);
    if (bench.status().fault() == Fault::kConfig || bench.status().fault() == Fault::kUsage)
        return bench.status();
    if (!bench.ok())
        journal(Priority::kError, "every slot will be missed: %s", bench.status().message());
    const BoardStore board = TRY(BoardStore::make(config.output, words.root));
    SnapshotWords how;
    how.raw = config.output.keep_raw;
    how.device = board.device;
    how.source = source_of(config, false);
    const std::unique_ptr<RunMemory> memory = TRY(carve_memory(config, bare, bench));
    CamerasPower cameras(told ? CamerasBetween::kOn : cameras_between(config));
    use_ports(cameras, config);
    const auto in_office = [&](FunctionRef<Status()> work) { return memory->safely(work); };
    Series series({config, schedule, zone, board, bench, *time, cameras, watch, in_office}, how);
    TRY(series.begin(cause_of(watch)));
    GadgetChild child;
    if (config.usb.export_store && !told && !words.once)
        show_to_computers(child, words, loaded.file);
    memory->seal();
    watch.ready();
    if (words.once)
        return series.once();
    return series.run(told ? std::optional{words.rehearsed} : std::nullopt);
}

Status run(const RunWords& words)
{
    const LoadedConfig loaded = TRY(words.config.load());
    const Schedule schedule = TRY(make_schedule(loaded.config.schedule));
    const TimeZone zone = TRY(TimeZone::open(loaded.config.schedule.timezone));
    TRY(check(words, loaded.config, schedule));
    return go(words, loaded, schedule, zone);
}

} // namespace

void add_run(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("run", "Slot after slot by the schedule, for months");
    auto words = std::make_shared<RunWords>();
    words->config.add_to(*command);
    command->add_option("-o,--output,--store", words->root, "folder of the store, as for snap (default: output.folder)")
        ->type_name("DIR");
    CLI::Option* once =
        command->add_flag("--once", words->once, "the slot that is due now, or else one that nobody planned; then end");
    CLI::Option* rehearse =
        command
            ->add_option("--rehearse", words->rehearsed,
                         "so many slots at once, of recorded pictures: time is told, rests take none")
            ->check(CLI::Range(std::int64_t{1}, kMostRehearsed))
            ->type_name("SLOTS");
    once->excludes(rehearse);
    command->add_option("--from", words->from, "when a rehearsal begins, UTC (default: now)")->type_name("TIME");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
