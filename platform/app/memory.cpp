// dicot memory: what a configuration will take, before it takes it.
#include "cameras/shot.h"
#include "commands.h"
#include "config_words.h"
#include "match_bench.h"
#include "match_words.h"
#include "process_bench.h"
#include "run/run_budget.h"
#include "run/run_memory.h"
#include "snapshot.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/os/process_memory.h"
#include "dicot/record/record.h"
#include "dicot/uvc/uvc_camera.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

/// Threads' stacks, what the C library keeps, and pages of code that the bare program has not touched yet: 0.9 MiB
/// seen. The decoders have given their memory back before the matcher touches its own.
constexpr std::size_t kWorkingBytes = std::size_t{1088} * 1024;

/// The catalogue's block, and what reading records takes when a store starts.
constexpr std::size_t kStoreBytes = Catalogue::kHeapBytes + kRecordHeapBytes + kMaxRecordBytes + 64 * std::size_t{1024};

/// The frames that UvcCamera keeps; through the kernel's driver they are the kernel's.
std::size_t uvc_camera_bytes(int width, int height)
{
    return static_cast<std::size_t>(UvcOptions{}.slots) * frame_bytes({PixelFormat::kYuyv, width, height, 0});
}

struct MemoryWords
{
    MatchWords match;
    ConfigWords config;
    int width = 640;
    int height = 480;
    bool json = false;
};

void line(const char* what, std::size_t bytes)
{
    std::printf("%-36s %8.1f MiB\n", what, static_cast<double>(bytes) / (1 << 20));
}

void print(const SnapshotBench& bench, const RunBudget& budget)
{
    std::printf("%d x %d px, %d disparities, %d threads; what dicot run takes at most:\n", bench.plan.rig.width,
                bench.plan.rig.height, bench.plan.match.disparities, bench.plan.threads);
    std::printf("%-36s %12s %18s\n", "", "resident", "address space");
    const auto row = [](const char* what, std::size_t resident, std::size_t mapped) {
        std::printf("%-36s %8.1f MiB %14.1f MiB\n", what, static_cast<double>(resident) / (1 << 20),
                    static_cast<double>(mapped) / (1 << 20));
    };
    for (const RunBudget::Part& part : budget.parts())
        row(part.name, part.resident, part.mapped);
    row("dicot run", budget.resident(), budget.mapped());
}

nlohmann::json json_of(const SnapshotBench& bench, const RunBudget& budget)
{
    nlohmann::json parts = nlohmann::json::object();
    for (const RunBudget::Part& part : budget.parts())
        parts[part.key] = {{"resident_bytes", part.resident}, {"address_bytes", part.mapped}};
    return {{"width", bench.plan.rig.width},
            {"height", bench.plan.rig.height},
            {"disparities", bench.plan.match.disparities},
            {"threads", bench.plan.threads},
            {"parts", parts},
            {"compressor_bytes", bench.work->budget().encode},
            {"match_bytes", bench.work->budget().match},
            {"preview_bytes", bench.work->budget().preview},
            {"run_resident_bytes", budget.resident()},
            {"run_address_bytes", budget.mapped()}};
}

/// Of one configuration, with its rig file, and its recorded pictures or the cameras that are plugged in.
Status run_of_config(const MemoryWords& words)
{
    RunMemory::keep_address_space_known();
    const LoadedConfig loaded = TRY(words.config.load());
    const BareProcess bare = TRY(BareProcess::measure());
    const std::unique_ptr<SnapshotBench> bench = TRY(SnapshotBench::make(loaded.config));
    const CameraMemory cameras = TRY(CameraMemory::measure(loaded.config));
    const RunBudget budget = TRY(run_budget(loaded.config, bare, cameras, bench->work->budget(), bench->plan.threads));
    if (words.json)
        std::printf("%s\n", json_of(*bench, budget).dump(2).c_str());
    else
        print(*bench, budget);
    return {};
}

Status run(const MemoryWords& words)
{
    const int threads = words.match.resolved_threads();
    const MatchOptions options = words.match.resolved();
    const MatchBudget budget = TRY(match_budget(words.width, words.height, options, threads));
    const Result<ProcessBudget> process = process_budget(words.width, words.height, Pictures::kRaw, options, threads);
    const std::size_t shot = Shot::scratch_bytes(words.width, words.height);
    const Result<ProcessBudget> snap =
        process_budget(words.width, words.height, Pictures::kRaw, options, threads, shot);
    const ProcessMemory bare = TRY(process_memory());
    const std::size_t program = static_cast<std::size_t>(bare.resident_bytes) + kWorkingBytes;
    const std::size_t total = program + budget.total();
    if (words.json) {
        nlohmann::json report = {{"width", words.width},
                                 {"height", words.height},
                                 {"disparities", words.match.options.disparities},
                                 {"threads", threads},
                                 {"program_bytes", program},
                                 {"pictures_bytes", budget.pictures},
                                 {"matcher_bytes", budget.matcher},
                                 {"output_bytes", budget.output},
                                 {"total_bytes", total}};
        report["process_total_bytes"] =
            process.ok() ? nlohmann::json(program + process.value().total()) : nlohmann::json();
        report["snap_total_bytes"] =
            snap.ok() ? nlohmann::json(program + kStoreBytes + snap.value().total()) : nlohmann::json();
        report["uvc_camera_bytes"] = uvc_camera_bytes(words.width, words.height);
        std::printf("%s\n", report.dump(2).c_str());
        return {};
    }
    std::printf("%d x %d px, %d disparities, %d threads\n", words.width, words.height, words.match.options.disparities,
                threads);
    line("program, libraries, stacks", program);
    line("pictures", budget.pictures);
    line("matcher: tables, planes, maps", budget.matcher);
    line("output", budget.output);
    line("peak of dicot match", total);
    if (!process.ok() || !snap.ok()) {
        std::printf("dicot process: %s\n", process.status().message());
        return {};
    }
    line("dicot process takes at most", program + process.value().total());
    line("dicot snap takes at most", program + kStoreBytes + snap.value().total());
    line("and for each camera through libusb", uvc_camera_bytes(words.width, words.height));
    return {};
}

} // namespace

void add_memory(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("memory", "Memory that a configuration takes");
    auto words = std::make_shared<MemoryWords>();
    words->config.add_to(*command);
    command->add_option("--width", words->width, "picture width, px")->capture_default_str();
    command->add_option("--height", words->height, "picture height, px")->capture_default_str();
    command->add_option("--disparities", words->match.options.disparities, "width of the search range, px")
        ->capture_default_str();
    command->add_flag("--dense", words->match.options.dense, "as for match");
    words->match.add_to(*command);
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] {
        chosen = [words] { return words->config.file.empty() ? run(*words) : run_of_config(*words); };
    });
}

} // namespace dicot::app
