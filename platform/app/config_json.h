// A configuration for a program.
#pragma once

#include "config/config.h"

#include <string>

namespace dicot::app {

/// Sections, and in each its keys: value, where it comes from, default, unit, what is allowed. Paths are seen from
/// `here`.
std::string config_json(const LoadedConfig& loaded, const std::string& here);

} // namespace dicot::app
