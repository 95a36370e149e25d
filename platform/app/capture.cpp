// dicot capture: pairs of pictures from both cameras, and what was found out about them.
#include "cameras/shot_record.h"
#include "commands.h"
#include "config_words.h"
#include "output_folder.h"
#include "sealed_heap.h"
#include "stop_request.h"
#include "take_picture.h"

#include "dicot/os/memory_block.h"
#include "dicot/os/output_file.h"
#include "dicot/os/process_memory.h"
#include "dicot/picture/write_picture.h"
#include "dicot/record/record.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

namespace dicot::app {
namespace {

constexpr int kMostPairs = 999;

struct CaptureWords
{
    ConfigWords config;
    std::string folder;
    int pairs = 1;
    bool json = false;
};

struct PairNames
{
    std::string left, right;
};

/// left.png, or left001.png of several.
PairNames names_of(const CaptureWords& words, int pair)
{
    char number[16] = "";
    if (words.pairs > 1)
        std::snprintf(number, sizeof number, "%03d", pair + 1);
    return {words.folder + "/left" + number + ".png", words.folder + "/right" + number + ".png"};
}

/// A record of a miss is nothing that anybody wants to keep.
bool is_a_miss(const std::string& path)
{
    std::ifstream file(path);
    const nlohmann::json record = nlohmann::json::parse(file, nullptr, false);
    return record.is_object() && record.value("outcome", nlohmann::json()) == "missed";
}

Status check_folder(const CaptureWords& words)
{
    TRY(make_folder(words.folder));
    const std::string record = words.folder + "/record.json";
    OutputFile can_be_written;
    TRY(can_be_written.open(record.c_str()));
    std::error_code error;
    if (std::filesystem::exists(record, error) && !is_a_miss(record))
        return failure(Fault::kCannotCreate, "%s is there already: name another folder with -o", record.c_str());
    for (int pair = 0; pair < words.pairs; ++pair) {
        const PairNames names = names_of(words, pair);
        for (const std::string& name : {names.left, names.right})
            if (std::filesystem::exists(name, error) || error)
                return failure(Fault::kCannotCreate, "%s is there already: name another folder with -o", name.c_str());
    }
    return {};
}

Status take_pairs(const CaptureWords& words, Shot& shot, MemoryBlock& memory, nlohmann::json& pairs,
                  std::vector<std::string>& warnings)
{
    const int width = shot.rig().width();
    const int height = shot.rig().height();
    TRY(shot.begin());
    for (int pair = 0; pair < words.pairs; ++pair) {
        const PairNames names = names_of(words, pair);
        {
            const SealedHeap sealed;
            Arena arena(memory.bytes());
            const auto left = take_picture<Rgb8>(arena, width, height);
            const auto right = take_picture<Rgb8>(arena, width, height);
            TRY(shot.take(left, right, arena));
            TRY(write_png(names.left.c_str(), left));
            TRY(write_png(names.right.c_str(), right));
        }
        nlohmann::json record = shot_record(shot.figures());
        record["warnings"] = shot_warnings(shot.rig(), shot.figures());
        for (const std::string& warning : shot_warnings(shot.rig(), shot.figures()))
            if (std::ranges::find(warnings, warning) == warnings.end())
                warnings.push_back(warning);
        record["left"] = std::filesystem::path(names.left).filename().string();
        record["right"] = std::filesystem::path(names.right).filename().string();
        pairs.push_back(record);
        if (!words.json)
            std::printf("%s, %s: skew %.1f ms, %d of %d pairs used\n", names.left.c_str(), names.right.c_str(),
                        static_cast<double>(shot.figures().burst.skew_us) / 1000, shot.figures().burst.used,
                        shot.figures().burst.pairs);
    }
    return shot.end();
}

Status run(const CaptureWords& words)
{
    const LoadedConfig loaded = TRY(words.config.load());
    const StopRequest stop;
    RigStream rig = TRY(RigStream::open(loaded.config, Pace::kAtOnce));
    TRY(check_folder(words));
    Arena measure;
    (void)take_picture<Rgb8>(measure, rig.width(), rig.height());
    (void)take_picture<Rgb8>(measure, rig.width(), rig.height());
    (void)measure.take<std::byte>(Shot::scratch_bytes(rig.width(), rig.height()));
    MemoryBlock memory = TRY(MemoryBlock::map(measure.peak()));
    Shot shot(rig, loaded.config, nullptr);
    nlohmann::json pairs = nlohmann::json::array();
    std::vector<std::string> warnings;
    const Status status = take_pairs(words, shot, memory, pairs, warnings);

    nlohmann::json record = {{"format", kRecordFormat},
                             {"software", "dicot " DICOT_VERSION},
                             {"outcome", status.ok() ? "done" : "missed"},
                             {"reason", status.ok() ? nlohmann::json() : nlohmann::json(status.message())},
                             {"cameras", cameras_record(rig)},
                             {"pairs", pairs},
                             {"warnings", warnings},
                             {"peak_memory_bytes", TRY(process_memory()).peak_bytes}};
    const std::string text = record.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    OutputFile file;
    TRY(file.open((words.folder + "/record.json").c_str()));
    TRY(file.write(text.data(), text.size()));
    TRY(file.commit());
    for (const std::string& warning : warnings)
        std::fprintf(stderr, "dicot: %s\n", warning.c_str());
    if (words.json)
        std::fputs(text.c_str(), stdout);
    return status;
}

} // namespace

void add_capture(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("capture", "Pictures from both cameras: the best pair of a burst");
    auto words = std::make_shared<CaptureWords>();
    words->config.add_to(*command);
    command->add_option("-o,--output", words->folder, "folder for left and right pictures (PNG) and record.json")
        ->required();
    command->add_option("--pairs", words->pairs, "how many")->check(CLI::Range(1, kMostPairs))->capture_default_str();
    command->add_flag("--json", words->json, "the record on standard output too");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
