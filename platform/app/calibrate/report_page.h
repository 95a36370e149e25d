// The sections of the report's page.
#pragma once

#include "report_measures.h"
#include "report_pictures.h"

#include <optional>
#include <string>
#include <vector>

namespace dicot::app {

/// The verdict and what to do next.
std::string verdict_section(const CalibrationRun& run);
/// The expected depth errors.
std::string millimetres_section(const CalibrationRun& run);
/// Every number of the quality with a sentence, both lenses and the rig with their deviations.
std::string numbers_section(const CalibrationRun& run);
std::string coverage_section(const CalibrationRun& run);
std::string residual_section(const CalibrationRun& run);
/// `shown` is the index of the pair whose rectified pictures were written.
std::string rectified_section(const CalibrationRun& run, const Result<Rectification>& flat,
                              std::optional<std::size_t> shown, const PairPictures& pictures);
std::string pairs_section(const CalibrationRun& run, const std::vector<PairPictures>& pictures);
std::string limits_section(const CalibrationRun& run);

} // namespace dicot::app
