// Everything that is stored, read and compared.
#pragma once

#include "snapshot_folder.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/store/store.h"

namespace dicot {

enum class Verify
{
    kOnly,      ///< somebody else may be writing
    kOwn,       ///< this process has the lock
    kAndRepair, ///< and mends
};

Result<VerifyReport> verify_folders(Medium& medium, Catalogue& catalogue, const ReadingDesk& desk, Verify how,
                                    FunctionRef<void(const Finding&)> found,
                                    FunctionRef<void(int done, int all)> progress);

/// Whether another process has the lock just now.
bool is_written_to(Medium& medium);

} // namespace dicot
