// A board of ours on the cable: it lists its snapshots, takes marks and the time.
#pragma once

#include "device_source.h"
#include "device_talk.h"

namespace dicot::app {

/// Fault::kBadData: it does not say what it is called.
Result<std::unique_ptr<PullSource>> open_board(std::shared_ptr<DeviceTalk> talk);

} // namespace dicot::app
