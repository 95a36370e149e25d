// A few days of a store on a card, and all that was promised at each moment of them.
#pragma once

#include "crash_medium.h"
#include "crash_vfs.h"

#include "dicot/store/store.h"

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace dicot::test {

using Files = std::map<std::string, std::string>; ///< name -> bytes

/// How much of the card's log was written when something happened.
using Moment = std::size_t;
inline constexpr Moment kNever = std::numeric_limits<Moment>::max();

struct Content
{
    bool done = false;
    std::string reason;
    Files files;
};

struct Told
{
    std::int64_t sequence = 0;
    std::string folder;
    std::optional<std::int64_t> due_us;
    std::vector<Content> contents; ///< one for each commit() that was tried; what was acknowledged is the last
    Moment begin_from = kNever, begun = kNever;
    Moment commit_from = kNever, acknowledged = kNever;
    std::int64_t pulled_us = 0;
    Moment pull_from = kNever, pulled = kNever;
    Moment prune_from = kNever;
};

/// After a fault: how often the store said no.
struct Story
{
    std::vector<Told> all;
    int refusals = 0;
    int misses = 0; ///< of those, recorded by the store
    std::string first_refusal;
};

struct StoryRules
{
    StoreRules store{std::uint64_t{1} << 20, Prune::kPulled};
    std::size_t most_file_bytes = 6000;
};

/// Opens, stores, misses, marks, prunes, closes, and all of it again; the clock goes over midnight and falls back to
/// 1970. When the store says no, the snapshot becomes a miss as in a real run, and the story goes on.
Story tell(CrashMedium& card, CrashVfs& vfs, const StoryRules& rules = {});

/// Only snapshots, `slots` of them, on a card that becomes full.
Story tell_until_full(CrashMedium& card, CrashVfs& vfs, const StoryRules& rules, int slots);
/// Snapshots on a card with room for few: the older ones go, also those that nobody has.
Story tell_of_small_card(CrashMedium& card, CrashVfs& vfs);
/// Two snapshots; in the midst of the second one somebody else takes all the room there is.
Story tell_with_a_thief(CrashMedium& card, CrashVfs& vfs, const StoryRules& rules);

/// One more snapshot, into `told`; what the store says to it.
Status store_snapshot(CrashMedium& card, Store& store, std::int64_t began_us, unsigned seed,
                      std::size_t most_file_bytes, Told& told);

} // namespace dicot::test
