// What a store does before its first snapshot: ends what an interruption left.
#pragma once

#include "snapshot_folder.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/store/store.h"

#include <memory>
#include <string>

namespace dicot {

/// incoming/, leaving/, quarantine/, for good.
Status make_rooms(Medium& medium);

/// Opens the catalogue for writing; one that is damaged is moved to quarantine/ and made again.
Result<std::unique_ptr<Catalogue>> open_catalogue(Medium& medium, const std::string& path, const char* vfs,
                                                  StartReport& report);

/// What becomes of folders whose record cannot be read.
enum class Unreadable
{
    kLeftOut, ///< verify names them, and repair puts them in quarantine
    kNamed,   ///< a row that says so: for who reads without a catalogue
};

/// Rows for all folders that have none, and marks that rows have lost. False: the card would not let it read a folder,
/// and a later start may have more luck. `highest` becomes the highest number that a folder has, if that is more.
Result<bool> add_rows(Medium& medium, Catalogue& catalogue, const ReadingDesk& desk, StartReport& report,
                      std::int64_t& highest, Unreadable unreadable = Unreadable::kLeftOut);

/// Every snapshot in incoming/ gets its place: as it is if it is whole, else as a miss. What cannot be mended goes to
/// quarantine, or stays: it never blocks the start. `cause`: as StoreRules has it.
Status end_interrupted(Medium& medium, Catalogue& catalogue, const ReadingDesk& desk, const ShortText<159>& cause,
                       StartReport& report);

/// The highest number that was ever given, by the rows and by the names in all rooms.
Result<std::int64_t> last_sequence_of(Medium& medium, Catalogue& catalogue);

/// Moves an entry to quarantine/ under its own name, or with ".2" and so on.
Status quarantine(Medium& medium, const StorePath& path);
/// How many entries it has.
int count_quarantine(Medium& medium);

/// A file whose room is given back for the record of a miss.
void keep_ballast(Medium& medium, std::uint64_t reserve_bytes);
bool release_ballast(Medium& medium);

} // namespace dicot
