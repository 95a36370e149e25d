// Traits and growth of a board for programs.
#pragma once

#include "growth_series.h"

#include <nlohmann/json_fwd.hpp>

namespace dicot::app {

/// {"device", "timezone", "slots", "measured", "gaps", "plants": [{"plant", "name", "series": [{"trait", "unit",
/// "samples", "curve", "daily", ...}], "leaves"}]}; times are UTC, what is not known is null.
nlohmann::json growth_json(const BoardTraits& board, const BoardGrowth& growth);

} // namespace dicot::app
