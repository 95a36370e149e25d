// A configuration for a program.
#pragma once

#include "config/config.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace dicot::app {

/// Sections, and in each its keys: value, where it comes from, default, unit, what is allowed. Paths are seen from
/// `here`.
std::string config_json(const LoadedConfig& loaded, const std::string& here);

/// The values alone: {"cameras": {"left": "", ...}, ...}.
nlohmann::json config_values(const Config& config);

} // namespace dicot::app
