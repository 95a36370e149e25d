// The one slot of a number, wherever it lies.
#pragma once

#include "store_outcome.h"
#include "store_words.h"

#include <cstdint>

namespace dicot::app {

struct FoundSlot
{
    DeviceFolder device;
    SlotRow row;
};

/// Fault::kUsage: several boards have one of this number; kNoInput: none has, with those around it. What cannot be read
/// on the way goes to `outcome`.
Result<FoundSlot> find_slot(const FoundStores& found, std::int64_t sequence, StoreOutcome& outcome);

} // namespace dicot::app
