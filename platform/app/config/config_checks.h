// What one key cannot see: values that contradict each other.
#pragma once

#include "config.h"

namespace dicot::app {

/// Fault::kConfig, with loaded.file and the line: one camera on both sides, recorded pictures beside a camera, a range
/// that ends before it begins, scripts that do not go together, a schedule that is none, a time zone that this system
/// does not know.
Status check_together(const LoadedConfig& loaded);

} // namespace dicot::app
