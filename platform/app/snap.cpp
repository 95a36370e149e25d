// dicot snap: from two cameras to one compressed cloud, once.
#include "cameras/drawn_pair.h"
#include "commands.h"
#include "config_words.h"
#include "health/health_record.h"
#include "snapshot.h"
#include "stop_request.h"
#include "store/board_store.h"
#include "store/start_words.h"
#include "store/store_outcome.h"
#include "store/store_words.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct SnapWords
{
    ConfigWords config;
    std::string root;
    bool raw = false;
    bool preview = false;
    bool json = false;
};

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

void report(const SnapWords& words, SnapshotTold& told, const std::string& path)
{
    const std::string folder = path + "/" + told.folder;
    for (const std::string& warning : told.warnings)
        std::fprintf(stderr, "dicot: %s: %s\n", folder.c_str(), warning.c_str());
    for (const HealthFlag& flag : told.flags)
        std::fprintf(stderr, "dicot: %s: %s %s\n", name_of(flag.severity), flag.cause.c_str(), flag.action.c_str());
    if (words.json) {
        told.record["folder"] = folder;
        std::printf("%s\n", text_of_record(told.record).c_str());
    } else if (told.status.ok()) {
        print(told.record, folder);
    }
    if (!told.stored)
        std::fprintf(stderr, "dicot: %s: not even the miss could be recorded: the next start will\n", folder.c_str());
    else if (!told.status.ok() && !words.json)
        std::fprintf(stderr, "dicot: the miss is recorded in %s/record.json\n", folder.c_str());
}

Status run(const SnapWords& words)
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
    const Result<std::unique_ptr<SnapshotBench>> bench = SnapshotBench::make(config);
    if (bench.status().fault() == Fault::kConfig || bench.status().fault() == Fault::kUsage)
        return bench.status();
    SnapshotWords how;
    how.raw = words.raw || config.output.keep_raw;
    how.preview = words.preview;
    how.source = source_of(config, is_drawn);
    const BoardStore board = TRY(BoardStore::make(config.output, words.root));
    const std::string& path = board.path;
    how.device = board.device;
    const WrittenStore opened = TRY(board.open_patiently(rules_of(config.output)));
    Store& store = *opened.store;
    tell_start(store, path);
    const ClockReading clock = read_clock(TRY(newest_time(store.catalogue())));
    HealthHistory history = read_history(*opened.medium, store.catalogue());
    how.card = card_health(*opened.medium, store.catalogue(), rules_of(config.output).reserve_bytes);
    Result<SnapshotTold> taken = take_snapshot(config, how, bench, clock, history, store);
    if (!taken.ok())
        return in_store(path, taken.status());
    report(words, taken.value(), path);
    return taken.value().status;
}

} // namespace

void add_snap(CLI::App& program, Command& chosen)
{
    CLI::App* command =
        program.add_subcommand("snap", "One snapshot: capture, rectify, match, triangulate, encode, store");
    auto words = std::make_shared<SnapWords>();
    words->config.add_to(*command);
    command
        ->add_option("-o,--output,--store", words->root,
                     "folder of the store: snapshots go to BOARD/DAY/NUMBER_TIME in it (default: output.folder)")
        ->type_name("DIR");
    command->add_flag("--raw", words->raw,
                      "keep both pictures as the cameras saw them too, as PNG (or output.keep_raw)");
    command->add_flag("--preview", words->preview, "picture of the cloud from two viewpoints too");
    command->add_flag("--json", words->json, "the record on standard output");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
