// A cloud whose colours tell the leaves apart, as a file.
#pragma once

#include "plant_work.h"

#include "dicot/codec/cloud_meta.h"

#include <string>

namespace dicot::app {

/// Neighbouring numbers are far apart in hue.
Rgb8 leaf_colour(int leaf);

/// .ply with numbers of leaf and plant for each point, or .drc with those of leaves (storage/FORMAT.md). What is no
/// leaf is grey. Fault::kUsage: another ending. Errors: those of the writers.
Status write_leaf_cloud(const std::string& path, const PlantWork& work, const CloudMeta& meta);

} // namespace dicot::app
