// Curves of growth as pictures: SVG files of their own, and a page with all of them.
#pragma once

#include "growth_series.h"

#include <string>
#include <vector>

namespace dicot::app {

/// Days of a board's plants on a scale.
struct DrawnPlot
{
    std::string file; ///< e.g. "b-3_plant1_height_p99_mm.svg"
    std::string title;
    std::string svg; ///< for a page that has the report's style
};

/// Of each plant and trait the samples, the curve with a band of two standard deviations, outliers as rings, and gaps
/// shaded; then the time of day where it is known, and all leaves' areas.
std::vector<DrawnPlot> growth_plots(const BoardTraits& board, const BoardGrowth& growth);

/// Writes the plots and index.html into `folder`. Fault::kCannotCreate, kIoError.
Status write_plots(const std::string& folder, const std::vector<DrawnPlot>& plots);

} // namespace dicot::app
