// What this process holds, for tests that want nothing to grow.
#pragma once

namespace dicot {

struct Holdings
{
    long descriptors = 0;  ///< open files, that of the look itself among them
    long maps = 0;         ///< mappings of memory
    long resident_kib = 0; ///< pages that are there

    /// From /proc/self; ends the program with 74 where that cannot be read. Takes nothing by operator new.
    static Holdings now();
};

} // namespace dicot
