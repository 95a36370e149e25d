// The growth of a board as the page reads it.
#pragma once

#include "../traits/growth_series.h"

#include <nlohmann/json_fwd.hpp>

namespace dicot::app {

/// README.md, "What the page reads"; not complete.
nlohmann::json curves_json(const BoardTraits& board, const BoardGrowth& growth);
/// The same before anything is measured.
nlohmann::json no_curves();

} // namespace dicot::app
