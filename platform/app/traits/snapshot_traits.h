// What one snapshot says of its plants and leaves, kept without its cloud.
#pragma once

#include "../plant/plant_work.h"

#include "dicot/plant/tracking.h"
#include "dicot/plant/traits.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dicot::app {

struct PlantSeen
{
    PlantTraits traits;
    PlantStand stand;
};

struct SnapshotTraits
{
    bool too_few_points = false; ///< nothing could be measured; see PlantView
    bool ground_known = false;
    std::vector<PlantSeen> plants;
    std::vector<LeafTraits> leaves;

    /// Of the cloud in a file. Errors: those of CloudOnDisk::read() and PlantWork::make().
    static Result<SnapshotTraits> read(const std::string& path, std::span<const PlantPlace> places);
};

/// For the cache alone: every number comes back as it was.
nlohmann::json json_of(const SnapshotTraits& traits);
/// None: not what json_of() made.
std::optional<SnapshotTraits> traits_of(const nlohmann::json& json);

} // namespace dicot::app
