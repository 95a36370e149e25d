// From a path to a connection that may be trusted.
#pragma once

#include "database.h"

#include "dicot/catalogue/catalogue.h"

namespace dicot {

/// As Catalogue::open(). The table is there, and nothing else is.
Result<Database> open_database(const std::string& path, Catalogue::Access access, const char* vfs);

} // namespace dicot
