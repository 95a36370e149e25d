// The folder of what one start leaves for the next.
#pragma once

#include "dicot/base/status.h"

namespace dicot::app {

/// Makes `path` where it is missing (its parent must be there) and sees that it can be written to.
/// Fault::kCannotCreate, with the remedy.
Status open_state_folder(const char* path) noexcept;

} // namespace dicot::app
