// Which plants stand where: the table behind --plants.
#pragma once

#include "plant_work.h"

#include <string>
#include <vector>

namespace dicot::app {

/// A CSV table with the columns name, min_x_mm, min_y_mm, min_z_mm, max_x_mm, max_y_mm, max_z_mm: a box in the ground
/// frame for each plant; an empty cell is no bound. Fault::kNoInput: missing; kBadData: a column is missing, a cell is
/// no number, a box is empty, a name is missing or stands twice, there are none or more than 255.
Result<std::vector<PlantPlace>> read_plant_places(const std::string& path);

} // namespace dicot::app
