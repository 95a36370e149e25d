// A calibration as a page that opens without a network.
#pragma once

#include "calibration_run.h"

namespace dicot::app {

/// Writes index.html and its pictures into `folder`, which is made if it is not there. The page is XML too, refers to
/// nothing outside of the folder, and appears last: after a failure there is none. The pictures of the pairs are read
/// again; one that cannot be read is noted on the page. A run that was refused (no views in its calibration) gives a
/// page of the pairs alone, with quality.advice for the reason. Fault::kCannotCreate and kIoError.
Status write_report(const CalibrationRun& run, const std::string& folder);

} // namespace dicot::app
