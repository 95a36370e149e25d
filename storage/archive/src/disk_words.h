// What the archive does to a computer's disk, in sentences.
#pragma once

#include "dicot/base/status.h"
#include "dicot/medium/medium.h"

namespace dicot {

/// Fault::kIoError: what failed with which path, why, and the remedy; ok if nothing failed.
Status on_disk(Errno outcome, const char* path, const char* doing);

/// Fault::kIoError with figures: less is free than what is still to come.
Status has_room(Medium& medium, std::uint64_t wanted_bytes);

} // namespace dicot
