// Marks in the folders of snapshots that hosts have.
#pragma once

#include "card.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/store/store.h"

#include <span>

namespace dicot {

/// As Store::mark_pulled().
Status mark_pulls(Medium& medium, Catalogue& catalogue, std::span<const Pull> pulls);

/// Writes the mark anew that a row remembers. A mark that is there must have been removed.
Status restore_mark(Medium& medium, const SlotRow& row);

} // namespace dicot
