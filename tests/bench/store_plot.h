// The figures of store_bench as a picture.
#pragma once

#include "dicot/base/status.h"

#include <string>
#include <vector>

namespace dicot::bench {

/// Of a block of snapshots.
struct StoreBlock
{
    int last = 0; ///< how many there are at its end
    double commit_median_ms = 0;
    double commit_p99_ms = 0;
    double cpu_median_ms = 0; ///< processor time of a whole snapshot: begin, add, commit
    double resident_mib = 0;
    double heap_mib = 0; ///< of SQLite, peak
};

/// SVG, light, with words. `title`: one line.
Status write_store_plot(const std::string& path, const std::string& title, const std::vector<StoreBlock>& blocks);

} // namespace dicot::bench
