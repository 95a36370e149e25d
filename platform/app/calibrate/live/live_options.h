// The words of the command line that a live calibration has of its own.
#pragma once

#include "../../config_words.h"
#include "../board_words.h"
#include "live_run.h"

#include <optional>
#include <string>

namespace dicot::app {

struct LiveOptions
{
    bool on = false;
    bool resume = false;
    std::optional<int> pairs;
    std::optional<double> seconds;
    ConfigWords config;

    /// Fault::kUsage: one of these words stands without --live.
    Status refuse_without_live() const;
};

constexpr int kUsualLivePairs = 20;
constexpr double kUsualLiveSeconds = 900;

void add_live_options(CLI::App& command, LiveOptions& options);

/// As read_board_words(), but the folder need not be named: then it is pairs_beside() the rig file. Fault::kUsage too
/// where there is more than one folder or board.
Result<std::vector<PictureSet>> read_live_words(std::span<const BoardWord> words, const std::string& rig_path);

/// `plan` comes from read_live_words().
LivePlan live_plan(const LiveOptions& options, const CalibrationPlan& plan, const std::string& rig_path, bool json);

} // namespace dicot::app
