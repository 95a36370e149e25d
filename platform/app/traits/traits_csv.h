// Traits as tables: a line a plant and snapshot, and a line a leaf.
#pragma once

#include "growth_series.h"

#include <string>

namespace dicot::app {

/// The line of names. Missed slots have a line too, with the reason and without a plant.
std::string plant_csv_names();
std::string plant_csv(const BoardTraits& board, const BoardGrowth& growth);

std::string leaf_csv_names();
std::string leaf_csv(const BoardTraits& board, const BoardGrowth& growth);

} // namespace dicot::app
