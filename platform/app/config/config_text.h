// A configuration as a commented TOML file.
#pragma once

#include "config.h"

namespace dicot::app {

/// All that holds, with where each value comes from. Paths are seen from `here`, so that the text means the same in
/// every folder: parse_config() takes it and finds the same values.
std::string config_toml(const LoadedConfig& loaded, const std::string& here);

/// The defaults, every key in a remark: a file to begin with.
std::string config_sample();

} // namespace dicot::app
