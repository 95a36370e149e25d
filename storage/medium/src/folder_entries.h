// What stands in a folder of a mounted file system.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/medium/medium.h"

namespace dicot {

/// As Medium::kind_of(), of a name in an open folder.
Errno kind_at(int folder, const char* name, EntryKind& kind) noexcept;

/// As Medium::list(), below the open folder `root`.
Errno list_entries(int root, const char* path, FunctionRef<bool(const MediumEntry&)> visit);

} // namespace dicot
