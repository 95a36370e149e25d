// A folder of a mounted file system.
#pragma once

#include "dicot/base/status.h"
#include "dicot/medium/medium.h"

#include <memory>
#include <string>

namespace dicot {

/// Opens the folder at `path`, which must be there; for reading alone it may be on a card that is read-only.
/// Fault::kNoInput: it is missing or no folder.
Result<std::unique_ptr<Medium>> open_disk_medium(const std::string& path);

} // namespace dicot
