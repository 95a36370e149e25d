// Relative paths in a configuration.
#pragma once

#include "config_keys.h"

#include <string>

namespace dicot::app {

/// `path`, seen from `folder` if it is relative. An empty folder changes nothing.
std::string path_from(const std::string& folder, const std::string& path);

/// The folder that a file stands in; empty of a bare name.
std::string folder_of(const std::string& file);

/// The same for what `key` says, if it is a path.
void take_from(const std::string& folder, const ConfigKey& key, Config& config);

/// With all paths seen from `folder`: what is written elsewhere means the same.
Config all_taken_from(const std::string& folder, Config config);

} // namespace dicot::app
