// Folders that a command writes into.
#pragma once

#include "dicot/base/status.h"

#include <string>

namespace dicot::app {

/// Makes the folder unless it is there; the folder around it must be. Fault::kCannotCreate.
Status make_folder(const std::string& path);

} // namespace dicot::app
