// What an archive holds of one board, and what is missing; nothing is written.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/base/status.h"
#include "dicot/medium/medium.h"
#include "dicot/pull_archive/number_ranges.h"
#include "dicot/record/record.h"

#include <cstdint>
#include <optional>
#include <string>

namespace dicot {

struct ArchiveLook
{
    std::int64_t snapshots = 0;            ///< done and missed
    std::int64_t missed = 0;               ///< of them
    std::optional<RecordFacts> newest;     ///< the highest number
    std::uint64_t bytes = 0;               ///< of all files of them
    int incomplete = 0;                    ///< half-pulled, in incoming/
    std::uint64_t incomplete_bytes = 0;    ///< what is there of them
    int in_quarantine = 0;                 ///< damaged here, put aside
    std::string serial;                    ///< of the board; empty: never told
    std::optional<std::int64_t> pulled_us; ///< the last pull
    NumberRanges had;                      ///< what the source had at the last pull
    NumberRanges here;                     ///< numbers that are here
    NumberRanges waiting;                  ///< not here, and the source had them at the last pull
    NumberRanges lost;                     ///< not here, and not there either: pruned or lost before anybody pulled
};

/// `visit` hears of each snapshot that can be read, in ascending order; `flawed` of what is wrong with others.
/// Fault::kIoError: the folder cannot be listed.
Result<ArchiveLook> look_at_archive(Medium& medium, FunctionRef<void(const RecordFacts&)> visit,
                                    FunctionRef<void(const Status& flaw)> flawed);

struct ArchiveCheck
{
    std::int64_t snapshots = 0, damaged = 0; ///< folders
    std::uint64_t bytes = 0;                 ///< read and hashed
};

/// Reads and hashes everything; `found` hears of each flaw (Fault::kBadData, kNoInput: missing, kIoError: nobody can
/// say), `progress` of each folder and may return false to stop: Fault::kTryAgain.
Result<ArchiveCheck> check_archive(Medium& medium, FunctionRef<void(const Status& flaw)> found,
                                   FunctionRef<bool(std::int64_t done, std::int64_t all)> progress);

} // namespace dicot
