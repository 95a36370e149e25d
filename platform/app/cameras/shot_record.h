// What is kept about a pair, as record.json tells it.
#pragma once

#include "shot.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace dicot::app {

/// Cameras, plan, warm-up, exposure and what the cameras delivered.
nlohmann::json cameras_record(RigStream& rig);
/// One pair: times, skew, averaging, brightness, what both pictures show.
nlohmann::json shot_record(const ShotFigures& figures);

/// Sentences about what a person should look at: swapped cameras, too much light, exposures that differ.
std::vector<std::string> shot_warnings(RigStream& rig, const ShotFigures& figures);

} // namespace dicot::app
