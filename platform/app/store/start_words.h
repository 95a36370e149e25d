// What opening a store mended, for a person.
#pragma once

#include "dicot/store/store.h"

#include <string>

namespace dicot::app {

/// A line on stderr for each thing; nothing where nothing was mended.
void tell_start(Store& store, const std::string& path);

} // namespace dicot::app
