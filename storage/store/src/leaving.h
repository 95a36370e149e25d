// Snapshots on their way out: moved aside first, so that none is ever half there.
#pragma once

#include "card.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/store/store.h"

namespace dicot {

/// As Store::prune(); `prune` is the rule.
Result<PruneReport> prune_folders(Medium& medium, Catalogue& catalogue, Prune prune, const PruneWish& wish,
                                  FunctionRef<void(const SlotRow&)> going);

/// What is in leaving/ goes, and its rows say so for good.
Status finish_leaving(Medium& medium, Catalogue& catalogue);

} // namespace dicot
