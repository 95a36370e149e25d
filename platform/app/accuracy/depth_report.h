// A depth experiment as a page that opens without a network, with its plot and its table as files beside it.
#pragma once

#include "depth_run.h"

#include <string>

namespace dicot::app {

/// Writes accuracy.svg, accuracy.csv and, last, index.html into `folder`, which is made if it is not there. The page
/// refers to nothing outside of the folder. Fault::kCannotCreate and kIoError.
Status write_depth_report(const DepthRun& run, const DepthWords& words, const std::string& folder);

/// Errors and bound over the distance.
std::string depth_chart(const DepthRun& run);

} // namespace dicot::app
