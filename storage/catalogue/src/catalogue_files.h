// The files that SQLite would open by itself, looked at before it does.
#pragma once

#include "dicot/base/status.h"

#include <sqlite3.h>

namespace dicot {

/// Whether there is a catalogue at `path`. Fault::kBadData when SQLite must not be let at it: a link, a pipe or a
/// folder stands at one of its names, or a rollback journal does, which may name a file anywhere and have it deleted;
/// in WAL mode there is none. `vfs`: null: files of this system.
Result<bool> look_at_catalogue_files(const char* path, const char* vfs);

} // namespace dicot
