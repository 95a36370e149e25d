// The charts of the report as inline SVG: no script, colours by the classes of report_style.h, fixed decimals.
#pragma once

#include "report_measures.h"

#include <span>
#include <string>

namespace dicot::app {

/// Elements that the other drawings point to (hatching, rings); stands once on the page.
std::string shared_drawings();

/// The cells of one camera's picture by their number of corners, and the corners.
std::string coverage_chart(const CalibrationRun& run, Eye eye, std::span<const CornerMiss> corners);

/// Boards of the used views by distance, over the thirds of the working range.
std::string distance_chart(const CalibrationRun& run);

/// Misses of one camera as a cloud around 0; the outer circle is `reach` px wide.
std::string scatter_chart(std::span<const CornerMiss> misses, double rms_px, double reach);
/// A reach that shows nearly all of the misses, and the middle well.
double scatter_reach(std::span<const CornerMiss> misses, double rms_px);

/// Misses of one camera where they happen, drawn `factor` times as long.
std::string arrow_chart(std::span<const CornerMiss> misses, int width, int height, double factor);
/// 1, 2 or 5 times a power of ten, so that a miss of `rms_px` is about a sixtieth of the width.
double arrow_factor(double rms_px, int width);

/// RMS of each pair's two pictures, by the pair's number.
std::string pair_bars(const CalibrationRun& run);

/// How often which gap between the rows occurs.
std::string gap_histogram(const RowGaps& gaps);

} // namespace dicot::app
