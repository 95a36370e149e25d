#include "live_options.h"

#include "live_guide.h"
#include "pair_folder.h"

#include <algorithm>

namespace dicot::app {

Status LiveOptions::refuse_without_live() const
{
    const char* word = resume                 ? "--resume"
                       : pairs                ? "--pairs"
                       : seconds              ? "--seconds"
                       : !config.file.empty() ? "--config"
                                              : nullptr;
    if (word != nullptr)
        return failure(Fault::kUsage, "calibrate: %s goes with --live", word);
    return {};
}

void add_live_options(CLI::App& command, LiveOptions& options)
{
    command.add_flag("--live", options.on, "take the pairs now, guided: hold the board before the cameras as it says");
    command
        .add_option("--pairs", options.pairs,
                    "live: pairs to take, " + std::to_string(kUsualLivePairs) + " if not given")
        ->check(CLI::Range(calibration::kMinPairs, LiveGuide::kMostPairs));
    command
        .add_option("--seconds", options.seconds,
                    "live: calibrate after so long with the pairs that there are; " +
                        std::to_string(static_cast<int>(kUsualLiveSeconds)) + " if not given")
        ->check(CLI::Range(1.0, 86400.0));
    command.add_flag("--resume", options.resume, "live: go on with the pairs of an earlier run in the folder");
    options.config.add_to(command);
}

Result<std::vector<PictureSet>> read_live_words(std::span<const BoardWord> words, const std::string& rig_path)
{
    std::vector<BoardWord> all(words.begin(), words.end());
    if (std::ranges::none_of(all, [](const BoardWord& word) { return word.kind == BoardWord::kImages; }))
        all.insert(all.begin(), {BoardWord::kImages, pairs_beside(rig_path)});
    std::vector<PictureSet> sets = TRY(read_board_words(all));
    if (sets.size() != 1 || sets.front().boards.size() != 1)
        return failure(
            Fault::kUsage,
            "calibrate --live takes pairs of one board into one folder: name one, and calibrate several with "
            "--images afterwards");
    return sets;
}

LivePlan live_plan(const LiveOptions& options, const CalibrationPlan& plan, const std::string& rig_path, bool json)
{
    LivePlan live;
    live.board = plan.sets.front().boards.front();
    live.range = plan.range;
    live.pairs = options.pairs.value_or(kUsualLivePairs);
    live.seconds = options.seconds.value_or(kUsualLiveSeconds);
    live.folder = plan.sets.front().folder;
    live.resume = options.resume;
    live.config = options.config.file;
    live.rig = rig_path;
    live.json = json;
    return live;
}

} // namespace dicot::app
