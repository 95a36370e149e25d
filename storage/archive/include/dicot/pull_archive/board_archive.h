// The folder of one board in an archive on a computer: what was pulled is there whole, or not there.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/base/short_text.h"
#include "dicot/base/status.h"
#include "dicot/medium/medium.h"
#include "dicot/pull_archive/number_ranges.h"
#include "dicot/pull_archive/pull_source.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

namespace dicot {

/// What became of one snapshot.
enum class Took
{
    kNew,        ///< it is in its place, verified and synced
    kThere,      ///< it was there already, with the same digest
    kConflict,   ///< another snapshot of this number is there; it stays
    kDamaged,    ///< the source has not what its own digests say, twice
    kGone,       ///< the source has it no more
    kUnreadable, ///< the source failed; what arrived stays for the next time
};

struct Taken
{
    Took how = Took::kUnreadable;
    Status why;                                 ///< of the last four: one sentence
    std::array<std::byte, 32> sums{};           ///< of kNew and kThere: SHA-256 of SHA256SUMS
    std::uint64_t bytes = 0;                    ///< of kNew: of all its files
    std::optional<std::int64_t> put_aside = {}; ///< a damaged one of this number went to quarantine/
    bool stays_damaged = false;                 ///< a damaged one of this number is still in its place
};

/// What the archive is told of a pull, for whoever asks later what is missing.
struct LastPull
{
    std::int64_t pulled_us = 0; ///< since 1970, UTC, by this computer's clock
    NumberRanges had;           ///< sequence numbers that the source had
};

/// One writer at a time (the medium's lock). The medium's root is the board's folder. Not for several threads.
class BoardArchive
{
public:
    /// `serial`: of the board, empty if it is not known; the first one that is told stays the folder's for ever.
    /// Fault::kTryAgain: another pull writes here; kBadData: the folder is another board's; kUsage: it is a board's own
    /// store; kIoError.
    static Result<std::unique_ptr<BoardArchive>> open(Medium& medium, std::string_view serial);
    virtual ~BoardArchive() = default;

    /// When the snapshot of this number that is in its place began; none: there is none.
    virtual std::optional<std::int64_t> find(std::int64_t sequence) const = 0;
    virtual std::int64_t count() const = 0;
    /// It was begun and not ended, or went to quarantine/ and nothing stands in its place: to be taken whoever else has
    /// it.
    virtual bool is_owed(std::int64_t sequence) const = 0;

    /// Takes one over, resuming what an interruption left. `verify`: what is there is hashed before it is believed, and
    /// taken anew if it is damaged; so is what the source may be told of, and what is owed. A damaged one goes to
    /// quarantine/ only when the new one is complete. `arrived` hears of each piece (bytes of it) and returns false to
    /// stop: then Fault::kTryAgain. Fault::kUnavailable: the source has gone; kIoError: this disk is full or failed.
    virtual Result<Taken> take(PullSource& source, const OfferedSnapshot& offered, bool verify,
                               FunctionRef<bool(std::uint64_t bytes)> arrived) = 0;

    /// Notes what the source had; what a board told is not forgotten for a folder. Half-pulled snapshots that this
    /// board no longer has are let go. Fault::kIoError.
    virtual Status note(const LastPull& pull) = 0;

    /// The largest file that is taken: what FAT and MTP's 32 bits can hold.
    static constexpr std::uint64_t kMostFileBytes = 0xFFFF'FFFFU;
};

} // namespace dicot
