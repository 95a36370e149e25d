// What a command came to that asked several stores: each failure is said, and the worst is the command's.
#pragma once

#include "store_words.h"

#include "dicot/base/status.h"

#include <string>

namespace dicot::app {

/// A Status that came out of the store in `path`, whose own paths begin in that folder: with the folder in front of it,
/// unless it stands there already.
Status in_store(const std::string& path, const Status& status);

class StoreOutcome
{
public:
    /// With the folders that could not even be read.
    explicit StoreOutcome(const FoundStores& found);

    /// Keeps the worse of both, and says the other one on stderr.
    void add(const Status& status);
    /// Passing faults (Fault::kTryAgain) are the least; of the others the one with the higher exit code, of equals the
    /// first.
    const Status& worst() const { return worst_; }

private:
    Status worst_;
};

} // namespace dicot::app
