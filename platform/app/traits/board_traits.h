// Every snapshot of one board, measured.
#pragma once

#include "../store/store_words.h"
#include "snapshot_traits.h"
#include "traits_cache.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/os/time_zone.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dicot::app {

/// One slot of the series: its traits, or why there are none.
struct SlotTraits
{
    SlotRow row;
    std::optional<SnapshotTraits> traits;
    bool read = false; ///< its cloud was, now or before
    std::string gap;   ///< one sentence; empty where there are traits
};

struct BoardTraits
{
    std::string device;
    TimeZone zone;                 ///< where the plants stand, as far as a record says
    std::vector<SlotTraits> slots; ///< by number
    int from_cache = 0;
};

struct TraitsWishes
{
    SlotQuery query;
    std::vector<PlantPlace> places;
    std::string timezone;     ///< empty: as the newest record that has one
    std::string cache_folder; ///< empty: nothing is remembered
    std::string cache_name;   ///< behind the board's: of the places, whose figures are kept apart
    std::string maker;        ///< of the cache: the program
    int threads = 2;
};

/// Measures what the cache does not have. A snapshot that cannot be measured is a gap, and `flawed` hears of it, from
/// one thread at a time. Errors: those of ReadStore::open() and TraitsCache; Fault::kTryAgain: somebody wants an end
/// (StopRequest), and the cache has what was done; kConfig: no such time zone.
Result<BoardTraits> measure_board(const DeviceFolder& board, const TraitsWishes& wishes,
                                  FunctionRef<void(const Status&)> flawed);

} // namespace dicot::app
