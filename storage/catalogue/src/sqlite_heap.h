// All memory of SQLite, from one block.
#pragma once

#include "dicot/base/status.h"

#include <cstddef>

namespace dicot::sqlite_heap {

/// Takes the block and starts SQLite; later calls do nothing. Fault::kOsError: there is no memory; kSoftware: somebody
/// else in this process started SQLite first.
Status start();
/// How far into the block SQLite ever reached.
std::size_t peak_bytes();

} // namespace dicot::sqlite_heap
