// What is kept about a pair, as record.json tells it.
#pragma once

#include "shot.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace dicot::app {

/// "2026-06-01T12:00:00Z"; "unknown" of a clock that was never set.
std::string utc_words(std::int64_t us_since_1970);
/// "20260601T120000Z": the name of a snapshot's folder.
std::string utc_stamp(std::int64_t us_since_1970);

/// Cameras, plan, warm-up, exposure and what the cameras delivered.
nlohmann::json cameras_record(RigStream& rig);
/// One pair: times, skew, averaging, brightness, what both pictures show.
nlohmann::json shot_record(const ShotFigures& figures);

/// Sentences about what a person should look at: swapped cameras, too much light, exposures that differ.
std::vector<std::string> shot_warnings(RigStream& rig, const ShotFigures& figures);

} // namespace dicot::app
