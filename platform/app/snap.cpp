// dicot snap: from two cameras to one compressed cloud, once.
#include "cameras/drawn_pair.h"
#include "cameras/shot_record.h"
#include "cloud_report.h"
#include "commands.h"
#include "config_words.h"
#include "part_folder.h"
#include "sealed_heap.h"
#include "stop_request.h"

#include "dicot/os/output_file.h"
#include "dicot/os/process_memory.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

constexpr const char* kRecordFormat = "dicot record 1";

struct Words
{
    ConfigWords config;
    std::string folder;
    bool raw = false;
    bool preview = false;
    bool json = false;
};

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

std::int64_t utc_now_us()
{
    return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
}

/// What a snapshot found out, whether it succeeded or not.
struct Snapshot
{
    nlohmann::json record;
    std::vector<std::string> warnings;
    std::uint64_t peak_bytes = 0;
};

/// Paths and names may hold bytes that are no UTF-8.
std::string words_of(const nlohmann::json& record)
{
    return record.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

Status write_record(const nlohmann::json& record, const std::string& folder)
{
    const std::string text = words_of(record) + "\n";
    OutputFile file;
    TRY(file.open((folder + "/record.json").c_str()));
    TRY(file.write(text.data(), text.size()));
    return file.commit();
}

Status shoot(const Words& words, const Config& config, const std::string& folder, Snapshot& snapshot)
{
    RigStream rig = TRY(RigStream::open(config, Pace::kAtOnce));
    const CloudWords cloud = cloud_words(config);
    const CloudPlan plan = TRY(make_cloud_plan(cloud, rig.width(), rig.height(), "the cameras' picture"));
    const std::unique_ptr<CloudWork> work = TRY(CloudWork::make(plan, Shot::scratch_bytes(rig.width(), rig.height())));
    Shot shot(rig, config, words.raw ? folder : "");
    PictureNames names;
    names.left = folder + (words.raw ? "/rectified_left.jpg" : "/left.jpg");
    if (words.preview)
        names.preview = folder + "/preview.png";
    const std::string path = folder + "/cloud.drc";
    Status status;
    {
        const SealedHeap sealed;
        status = [&]() -> Status {
            TRY(work->see(shot, names, false));
            TRY(work->encode());
            TRY(work->write_cloud(path));
            return work->write_preview(names);
        }();
    }
    snapshot.record["cameras"] = cameras_record(rig);
    if (shot.figures().burst.used > 0) {
        snapshot.record["shot"] = shot_record(shot.figures());
        snapshot.warnings = shot_warnings(rig, shot.figures());
    }
    TRY(status);
    snapshot.peak_bytes = TRY(process_memory()).peak_bytes;
    snapshot.record["cloud"] = cloud_report(*work, cloud.match.method, snapshot.peak_bytes);
    snapshot.record["calibration_id"] = plan.meta.calibration_id.c_str();
    return {};
}

void print(const nlohmann::json& record, const std::string& folder)
{
    const nlohmann::json& shot = record["shot"];
    const nlohmann::json& cloud = record["cloud"];
    std::printf("%s: %lld points, %.2f MiB\n", folder.c_str(), cloud["points"].get<long long>(),
                cloud["bytes"].get<double>() / (1 << 20));
    std::printf("%s; %d of %d pairs used, skew %.1f ms\n", record["cameras"]["plan"]["why"].get<std::string>().c_str(),
                shot["pairs_used"].get<int>(), shot["pairs"].get<int>(), shot["skew_us"].get<double>() / 1000);
    const nlohmann::json& times = cloud["stages_s"];
    std::printf("capture %.2f s, rectify %.3f s, match %.3f s, triangulate %.3f s, encode and verify %.3f s\n",
                times["read"].get<double>(), times["rectify"].get<double>(), times["match"].get<double>(),
                times["triangulate"].get<double>(), times["encode"].get<double>());
}

/// Names files by where they would have been.
std::string reason_of(const Status& status, const PartFolder& folder)
{
    std::string reason = status.message();
    if (const std::size_t at = reason.find(folder.path()); at != std::string::npos)
        reason.replace(at, folder.path().size(), folder.target());
    return reason;
}

Status run(const Words& words)
{
    LoadedConfig loaded = TRY(words.config.load());
    Config& config = loaded.config;
    DrawnRig drawn;
    const bool is_drawn = loaded.file.empty() && no_camera_is_there();
    if (is_drawn) { // a board in the field has a configuration, and is never shown a plant that is not there
        TRY(drawn.open(config));
        std::fprintf(stderr, "dicot: there is no camera and no configuration: a drawn pair of pictures is used\n");
    }
    const StopRequest stop;
    const std::int64_t began_us = utc_now_us();
    const std::string around = words.folder.empty() ? config.output.folder : words.folder;
    PartFolder folder;
    TRY(folder.open(around, utc_stamp(began_us)));
    Snapshot snapshot;
    snapshot.record = {{"format", kRecordFormat}, {"software", "dicot " DICOT_VERSION}, {"time", utc_words(began_us)}};
    const Status status = shoot(words, config, folder.path(), snapshot);
    const bool tried = status.fault() != Fault::kConfig && status.fault() != Fault::kUsage;
    if (!tried || (!status.ok() && StopRequest::asked()))
        return status;
    const std::string reason = reason_of(status, folder);
    snapshot.record["source"] = is_drawn                                     ? "drawn pictures"
                                : config.cameras.left.by == BoundBy::kReplay ? "recorded pictures"
                                                                             : "cameras";
    snapshot.record["outcome"] = status.ok() ? "done" : "missed";
    snapshot.record["reason"] = status.ok() ? nlohmann::json() : nlohmann::json(reason);
    snapshot.record["warnings"] = snapshot.warnings;
    TRY(write_record(snapshot.record, folder.path()));
    TRY(folder.commit());
    for (const std::string& warning : snapshot.warnings)
        std::fprintf(stderr, "dicot: %s: %s\n", folder.target().c_str(), warning.c_str());
    if (words.json) {
        snapshot.record["folder"] = folder.target();
        std::printf("%s\n", words_of(snapshot.record).c_str());
    } else if (status.ok()) {
        print(snapshot.record, folder.target());
    } else {
        std::fprintf(stderr, "dicot: the miss is recorded in %s/record.json\n", folder.target().c_str());
    }
    return status.ok() ? status : failure(status.fault(), "%s", reason.c_str());
}

} // namespace

void add_snap(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("snap", "One snapshot: capture, rectify, match, triangulate, encode");
    auto words = std::make_shared<Words>();
    words->config.add_to(*command);
    command->add_option("-o,--output", words->folder,
                        "folder that gets a folder of the snapshot, named by its time in UTC (default: output.folder)");
    command->add_flag("--raw", words->raw, "keep both pictures as the cameras saw them too, as PNG");
    command->add_flag("--preview", words->preview, "picture of the cloud from two viewpoints too");
    command->add_flag("--json", words->json, "the record on standard output");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
