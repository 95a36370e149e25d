// A calibration as a page that opens without a network.
#pragma once

#include "calibration_run.h"

namespace dicot::app {

/// Writes index.html and its pictures into `folder`, which is made if it is not there. Fault::kCannotCreate and
/// kIoError; the pictures of the pairs are read again.
Status write_report(const CalibrationRun& run, const std::string& folder);

} // namespace dicot::app
