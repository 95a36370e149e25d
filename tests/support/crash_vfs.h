// SQLite on a CrashMedium: its writes and syncs stand in the same log as everybody's.
#pragma once

#include "crash_medium.h"

namespace dicot::test {

/// One process, one connection to a file: locks always succeed. Make it after the first Catalogue was opened, which
/// gives SQLite its memory. Paths begin at the medium's root.
class CrashVfs
{
public:
    static constexpr const char* kName = "dicot-crash";

    CrashVfs();
    CrashVfs(const CrashVfs&) = delete;
    CrashVfs& operator=(const CrashVfs&) = delete;
    ~CrashVfs();

    /// Where files are opened from now on.
    void use(CrashMedium& medium);
};

} // namespace dicot::test
