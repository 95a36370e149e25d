// What was measured on one cloud, for people, tables and programs.
#pragma once

#include "plant_work.h"

#include "dicot/codec/cloud_meta.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace dicot::app {

struct PlantReport
{
    const PlantWork& work;
    const std::string& cloud; ///< its file
    const CloudMeta& meta;
};

/// A few lines a plant, and one a leaf.
std::string plant_words(const PlantReport& report);

/// With a line of names; a line a plant.
std::string plant_table(const PlantReport& report);
/// With a line of names; a line a leaf.
std::string leaf_table(const PlantReport& report);

/// {"metadata": .., "observations": ..}, as PlantCV 4 keeps results: a sample for each plant ("plant_1") and each leaf
/// ("plant_1_leaf_3"), in each sample an observation a trait, with an `sd` beside `value`. What could not be measured
/// is null.
nlohmann::json plant_json(const PlantReport& report);

} // namespace dicot::app
