// The store of this board, for who writes snapshots into it.
#pragma once

#include "store_words.h"

#include <string>

namespace dicot::app {

struct BoardStore
{
    std::string root;
    std::string device;
    std::string path; ///< root/device

    /// Makes both folders. `root`: instead of output.folder, if it is not empty. Fault::kUsage: it is itself the folder
    /// of one board; kNoOutput: it cannot be made.
    static Result<BoardStore> make(const OutputConfig& output, const std::string& root);

    /// Another process may be pruning, verifying, or taking a snapshot: that is no reason for a miss at once. Waits a
    /// minute for it, or until somebody wants an end. Errors: those of WrittenStore::open(), with the path.
    Result<WrittenStore> open_patiently(const StoreRules& rules) const;
};

} // namespace dicot::app
