// What cannot give a calibration, and the advice that goes with it.
#pragma once

#include "lens_fit.h"

#include "dicot/calibration/solve.h"

namespace dicot::calibration {

/// Boards, views and corners that do not belong together, and too few pairs.
Status check_task(const CalibrationTask& task);
/// Views so much alike that one camera (`side`: "left" or "right") is not determined.
Status check_variety(const LensFit& fit, const char* side);
/// Cameras that are swapped or do not stand side by side.
Status check_sides(const Point3& shift_mm);

} // namespace dicot::calibration
