// One snapshot of a store, looked at by whoever wants to know it; nothing is written.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/base/status.h"
#include "dicot/catalogue/catalogue.h"
#include "dicot/medium/medium.h"

#include <string>

namespace dicot {

/// record.json as it stands there, which read_record() accepts. Fault::kNoInput: its folder is not in its place;
/// kBadData: it is no record, or another slot's; kIoError.
Result<std::string> read_record_text(Medium& medium, const SlotRow& row);

/// Reads and hashes SHA256SUMS and all that it names; `told` hears of each file: ok, missing or damaged
/// (Fault::kBadData, kIoError). How many there were that are not ok.
Result<int> check_snapshot(Medium& medium, const SlotRow& row,
                           FunctionRef<void(const char* name, const Status& outcome)> told);

} // namespace dicot
