// A signal to who serves, and to nobody else.
#pragma once

#include "dicot/base/status.h"

#include <string>
#include <sys/types.h>

namespace dicot::app {

/// Tells who holds the lock of the page at `path` to end, if it is this program. Its number, and 0: nobody serves. It
/// has not ended yet. Fault::kUnavailable: it is not this user's to end, is another program, or does not say who it is.
Result<pid_t> end_server(const std::string& path);

} // namespace dicot::app
