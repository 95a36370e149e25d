// A depth experiment as lines for a terminal, as JSON and as CSV.
#pragma once

#include "depth_run.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace dicot::app {

void print_run(const DepthRun& run, const DepthWords& words);
nlohmann::json as_json(const DepthRun& run, const DepthWords& words);
/// A line of names and one for each target; lengths in mm.
std::string as_csv(const DepthRun& run);

/// The largest error and how many stay under the bound, in one or two sentences.
std::string summary_of(const DepthRun& run);

} // namespace dicot::app
