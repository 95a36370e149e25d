// Growth of a board for a person.
#pragma once

#include "growth_series.h"

#include <string>

namespace dicot::app {

std::string growth_words(const BoardTraits& board, const BoardGrowth& growth);

} // namespace dicot::app
