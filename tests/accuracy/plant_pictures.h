// What people look at: clouds, disparities and errors of the plants, as PNG in DICOT_PICTURES_DIR.
#pragma once

#include "plant_pairs.h"

#include <string>

namespace dicot::test {

/// NAME_disparity.png, and NAME_cloud.png: the cloud from two places, cut out around the leaves in the picture, and
/// from 100 mm before to 100 mm behind them.
void draw_match(const std::string& name, const DisparityMap& map, const scenes::Picture& flat_left,
                const RectifiedView& view, const TrueDepth& truth);

/// NAME_error.png, around the leaves: the picture, our errors, the peer's. Leaf pixels seen by both cameras are green
/// up to 1 mm, yellow-green up to 3, orange up to 10, red beyond; violet: no value. Others are dark.
void draw_errors(const std::string& name, const PlantPair& pair, const TrueDepth& truth);

} // namespace dicot::test
