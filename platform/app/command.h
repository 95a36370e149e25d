// What every command of the program has in common.
#pragma once

#include "dicot/base/status.h"

#include <CLI/CLI.hpp>

#include <functional>

namespace dicot::app {

/// What the command line asked for: set by the chosen subcommand, run by main.
using Command = std::function<Status()>;

} // namespace dicot::app
