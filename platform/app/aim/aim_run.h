// dicot aim: looks through both cameras until somebody has seen enough.
#pragma once

#include "../config/config.h"

#include "dicot/base/status.h"

namespace dicot::app {

/// Streams, and tells figures to stdout, for `seconds` of the cameras' time (0: until Ctrl-C or SIGTERM); at the end a
/// summary. The cameras keep their own exposure. Errors: those of RigStream; kOsError; kIoError if stdout takes no
/// more.
Status aim(const Config& config, double seconds, bool json);

} // namespace dicot::app
