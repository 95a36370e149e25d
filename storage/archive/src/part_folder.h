// One snapshot on its way into the archive: incoming/<name>, whose files grow until all of them are right.
#pragma once

#include "disk_words.h"
#include "offer.h"

#include "snapshot_folder.h"

#include "dicot/base/function_ref.h"
#include "dicot/medium/medium.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// Who failed decides what becomes of the pull.
struct PartOutcome
{
    Status status;
    bool by_source = false;
    bool bytes_wrong = false; ///< what arrived is not what its digests say: not worth keeping
};

class PartFolder
{
public:
    using Arrived = FunctionRef<bool(std::uint64_t bytes)>;

    /// `piece`: how much is read at once.
    PartFolder(Medium& medium, const ReadingDesk& desk, std::span<std::byte> piece, const SnapshotName& name);

    const StorePath& path() const { return part_; }

    /// Takes over all that `offer` names, beginning with what is there already. What is there is hashed, never
    /// believed.
    PartOutcome fill(PullSource& source, const Offer& offer, Arrived arrived);
    /// All of it synced and renamed into its place.
    Status settle();
    /// So that an interruption before the first byte is known later.
    Status begin();
    /// Nothing of it is worth keeping.
    Status let_go();

private:
    Status prepare(const Offer& offer);
    Status write_sums(const Offer& offer);
    Status remove_strangers(const Offer& offer);
    PartOutcome take_file(PullSource& source, const OfferedFile& file, const Sum& sum, Arrived arrived);
    PartOutcome grow_file(PullSource& source, const OfferedFile& file, Sha256Stream& hash, Arrived arrived);
    PartOutcome read_on(PullSource& source, const OfferedFile& file, std::uint64_t from, Medium::File into,
                        Sha256Stream& hash, Arrived arrived);
    Status begin_anew(const StorePath& path);
    std::uint64_t size_of(const StorePath& path);

    Medium& medium_;
    const ReadingDesk& desk_;
    std::span<std::byte> piece_;
    SnapshotName name_;
    StorePath part_;
};

} // namespace dicot
