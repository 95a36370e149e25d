// The snapshots of one board on its card: durable or absent.
#pragma once

#include "dicot/base/byte_sink.h"
#include "dicot/base/function_ref.h"
#include "dicot/base/short_text.h"
#include "dicot/base/status.h"
#include "dicot/catalogue/catalogue.h"
#include "dicot/medium/medium.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace dicot {

/// What may be deleted to make room, oldest first. The newest snapshot stays always: it holds the sequence.
enum class Prune
{
    kNever,
    kPulled, ///< what a host has, verified
    kAll,    ///< then also what nobody has
};

struct StoreRules
{
    std::uint64_t reserve_bytes = std::uint64_t{256} << 20; ///< of the file system, left to others
    Prune prune = Prune::kPulled;
    ShortText<159> cause{}; ///< why a snapshot that the start finds begun was not finished, if it is known
};

/// When a slot was planned, and when it began. Microseconds since 1970, UTC; the second that each lies in is kept.
struct SlotTime
{
    std::int64_t began_us = 0;
    std::optional<std::int64_t> due_us;
};

/// What the catalogue keeps beside the record.
struct SlotOutcome
{
    bool done = false;
    ShortText<255> reason; ///< of a miss
    ShortText<31> clock_trust;
    std::int64_t points = 0;
};

/// A snapshot that a host has.
struct Pull
{
    std::int64_t sequence = 0;
    ShortText<64> sums; ///< SHA-256 of its SHA256SUMS, as the host has it
    std::int64_t pulled_us = 0;
};

/// What opening the store found and mended.
struct StartReport
{
    int finished = 0;           ///< snapshots that were whole when power went, and are now in their place
    int interrupted = 0;        ///< begun and not whole: now recorded as missed
    int left_over = 0;          ///< begun, and neither of both could be done: the next start tries again
    int rows_added = 0;         ///< folders that the catalogue did not know
    bool catalogue_new = false; ///< it was missing or damaged, and was made again
};

/// What verify() says about one place.
struct Finding
{
    enum class Kind
    {
        kDamaged,   ///< a file that is not what SHA256SUMS says, or cannot be read
        kMissing,   ///< a file, or the folder, that should be there
        kStranger,  ///< a file that the store did not make
        kCatalogue, ///< the catalogue differs from the folders
        kLeftOver,  ///< of a snapshot that was interrupted
    };
    Kind kind;
    std::int64_t sequence; ///< 0: of none
    const char* path;      ///< from the store's folder
    const char* sentence;  ///< what is wrong
    bool mended;           ///< by repair, which moves a damaged folder to quarantine
};

struct VerifyReport
{
    int folders = 0, findings = 0, mended = 0;
    std::uint64_t bytes = 0; ///< read and hashed
    int in_quarantine = 0;   ///< folders, now
};

struct PruneWish
{
    std::uint64_t free_bytes = 0;              ///< as much as shall be free; 0: nothing for that reason
    std::optional<std::int64_t> older_than_us; ///< and all that began before
    bool dry_run = false;
};

struct PruneReport
{
    int removed = 0;
    std::uint64_t bytes = 0;
};

/// One process writes at a time (the medium's lock). After open() nothing is taken from the heap but what the
/// catalogue's own block and the lent heap give.
class Store
{
public:
    /// Repairs what an interruption left. `catalogue`: the file's path, as SQLite opens it (kCatalogueName in the
    /// medium's root); `vfs` as for Catalogue::open(). Fault::kTryAgain: another process writes; kUsage: it is an
    /// archive, which dicot pull writes; kIoError: the card
    /// failed, is full or read-only.
    static Result<std::unique_ptr<Store>> open(Medium& medium, const StoreRules& rules, const std::string& catalogue,
                                               const char* vfs = nullptr);
    virtual ~Store() = default;

    virtual const StartReport& start_report() const = 0;
    virtual Catalogue& catalogue() = 0;

    /// Takes the next sequence number, for good, and begins its folder. One snapshot at a time.
    virtual Status begin(const SlotTime& time) = 0;
    virtual std::int64_t sequence() const = 0;
    /// Where the snapshot will stand: "2026-06-01/000017_20260601T120000Z".
    virtual const char* folder() const = 0;
    /// Whether the card has room, after pruning as the rules allow. Fault::kIoError, with figures and the remedy: it is
    /// a reason for a miss.
    virtual Status make_room() = 0;
    /// One more file, hashed on its way. Errors: those of `fill`; Fault::kIoError. A name of letters, digits, '.', '_'
    /// and '-', each at most once, kMaxFiles in all.
    virtual Status add(const char* name, FunctionRef<Status(ByteSink&)> fill) = 0;
    /// Of what was added so far, for the record.
    struct Added
    {
        ShortText<31> name;
        ShortText<64> sha256;
        std::uint64_t bytes = 0;
    };
    virtual void for_each_added(FunctionRef<void(const Added&)> visit) const = 0;
    /// Takes back all that was added: a miss keeps its record alone, for which a full card gives back the ballast.
    virtual Status take_back() = 0;
    /// Durable and in its place when it returns. After a failure the snapshot may be taken back and committed as a
    /// miss; if that fails too, the next begin() or open() records it as interrupted. Fault::kIoError.
    virtual Status commit(const SlotOutcome& outcome) = 0;

    /// Hosts have these snapshots, and their digests were right. Two syncs, however many they are. Nothing is marked
    /// after Fault::kNoInput: there is none of this number; kBadData: `sums` is not the digest of its SHA256SUMS.
    virtual Status mark_pulled(std::span<const Pull> pulls) = 0;
    /// Deletes as the wish and the rules say, and tells of each before it goes.
    virtual Result<PruneReport> prune(const PruneWish& wish, FunctionRef<void(const SlotRow&)> going) = 0;
    /// Reads and hashes everything. With `repair` damaged folders go to quarantine and the catalogue is made again.
    virtual Result<VerifyReport> verify(bool repair, FunctionRef<void(const Finding&)> found,
                                        FunctionRef<void(int done, int all)> progress) = 0;

    static constexpr const char* kCatalogueName = "catalogue.sqlite";
    static constexpr int kMaxFiles = 8;
};

/// The same looks at a store that is only read: a copy on a laptop, a card that is read-only, one that another process
/// writes to. Without a catalogue that can be used the folders are read instead, into memory.
Result<std::unique_ptr<Catalogue>> read_catalogue(Medium& medium, const std::string& catalogue);
Result<VerifyReport> verify_store(Medium& medium, const std::string& catalogue, FunctionRef<void(const Finding&)> found,
                                  FunctionRef<void(int done, int all)> progress);

/// "2026-06-01/000017_20260601T120000Z".
ShortText<63> folder_of(std::int64_t sequence, std::int64_t began_us);

} // namespace dicot
