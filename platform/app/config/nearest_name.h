// "Did you mean ...?"
#pragma once

#include "config_keys.h"

#include <string_view>

namespace dicot::app {

bool is_section_name(std::string_view name);

/// The section whose name needs the fewest letters changed.
const char* nearest_section(std::string_view name);

/// The key whose name needs the fewest letters changed; a key of another section counts as two letters more.
const ConfigKey& nearest_key(std::string_view section, std::string_view name);

} // namespace dicot::app
