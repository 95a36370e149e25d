// What a source offers of one snapshot, before a byte of it is taken: nobody else checks it.
#pragma once

#include "dicot/store/sums.h"
#include "folder_name.h"

#include "dicot/base/status.h"
#include "dicot/pull_archive/pull_source.h"

#include <array>
#include <string>

namespace dicot {

/// The name that the snapshot would have here. Fault::kBadData: a number or a time that no snapshot has.
Result<SnapshotName> name_of(const OfferedSnapshot& offered);

/// What is to be taken over.
struct Offer
{
    Sums sums;
    std::string sums_text;                     ///< SHA256SUMS, byte by byte
    ShortText<64> sums_sha256;                 ///< of these bytes
    std::array<OfferedFile, kMaxSums> files{}; ///< in the order of `sums`
    std::uint64_t bytes = 0;                   ///< of all of them together
};

/// Lists the files of one and reads SHA256SUMS. Fault::kBadData: it cannot be a snapshot; others: those of the source.
Result<Offer> read_offer(PullSource& source, const OfferedSnapshot& offered);

} // namespace dicot
