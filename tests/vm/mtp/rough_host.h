// What a computer may do to a device that it should not.
#pragma once

#include "still_image.h"

#include <cstdint>

namespace trial {

/// One trial of each kind that is written down, then `count` drawn out of `seed`. Behind each the device has to answer
/// like before. Prints what it does; false: the device did not come back, or shows something else.
bool be_hostile(StillImage& device, std::uint64_t seed, int count);

} // namespace trial
