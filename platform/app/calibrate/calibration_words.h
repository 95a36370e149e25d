// A calibration in words: for a person, and as JSON.
#pragma once

#include "calibration_run.h"

#include <nlohmann/json_fwd.hpp>

namespace dicot::app {

/// The pairs with what became of them; and, when it is solved, what came out, how far to trust it and what to do next.
void print_run(const CalibrationRun& run);

/// The same and the numbers themselves. Keys carry units.
nlohmann::json as_json(const CalibrationRun& run);

} // namespace dicot::app
