// No output of a command may be one of its inputs, or another output.
#pragma once

#include "dicot/base/status.h"

#include <initializer_list>
#include <string>

namespace dicot::app {

/// Empty names are left out; links and different spellings of one file are seen through.
/// Errors: kUsage, naming the file.
Status check_distinct(std::initializer_list<std::string> inputs, std::initializer_list<std::string> outputs);

} // namespace dicot::app
