// A board's folder on a device that is not ours: what its tree shows.
#pragma once

#include "device_talk.h"
#include "find_boards.h"

namespace dicot::app {

std::unique_ptr<PullSource> open_tree(std::shared_ptr<DeviceTalk> talk, const BoardFolder& folder);

} // namespace dicot::app
