// When a calibration was made.
#pragma once

#include "dicot/rig/rig_file.h"

namespace dicot::app {

/// Writes the time of the system's clock, or that of SOURCE_DATE_EPOCH, into rig.calibrated_at; a clock that stands
/// before 2020 was never set and gives none. Fault::kUsage: SOURCE_DATE_EPOCH is no number of seconds.
Status date_rig(RigFile& rig);

} // namespace dicot::app
