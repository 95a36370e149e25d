// One row for each slot: what happened, and where it went. A copy of what the folders say, for quick answers.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/base/short_text.h"
#include "dicot/base/status.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace dicot {

/// Where a slot's folder is.
enum class Kept
{
    kHere = 0,
    kPruned = 1,      ///< deleted to make room
    kQuarantined = 2, ///< damaged, and moved to quarantine/
    kLost = 3,        ///< somebody else took it away
};

inline constexpr std::int64_t kMaxSlotBytes = std::int64_t{1} << 40;

struct SlotRow
{
    std::int64_t sequence = 0;          ///< from 1
    std::int64_t began_us = 0;          ///< since 1970, UTC, by the board's clock; whole seconds: the folder bears it
    std::optional<std::int64_t> due_us; ///< when it was planned; none: somebody asked for it
    bool done = false;                  ///< false: missed
    ShortText<255> reason;              ///< of a miss
    ShortText<31> clock_trust;
    std::int64_t points = 0;
    std::int64_t bytes = 0; ///< of all files in the folder, without the mark of a pull; kMaxSlotBytes at most
    ShortText<64> sums;     ///< SHA-256 of SHA256SUMS, hexadecimal: names everything in the folder
    std::optional<std::int64_t> pulled_us; ///< when a host had it, verified
    Kept kept = Kept::kHere;

    friend bool operator==(const SlotRow&, const SlotRow&) = default;
};

struct SlotQuery
{
    std::optional<std::int64_t> since_us, until_us; ///< of began_us, both included
    bool missed_only = false;
    std::optional<std::int64_t> last; ///< only so many, the newest ones, still in ascending order
    std::optional<std::int64_t> first_sequence, last_sequence;
};

struct SlotTotals
{
    std::int64_t slots = 0, done = 0, missed = 0, pulled = 0, pruned = 0, quarantined = 0, lost = 0;
    std::int64_t bytes_here = 0;
};

/// How fast the card fills: of the newest rows.
struct SlotPace
{
    double bytes_per_day = 0;      ///< 0: not known, they are of less than six hours
    double bytes_per_snapshot = 0; ///< of those done
    std::int64_t most_bytes = 0;   ///< largest of them
};

/// SQLite in WAL mode: a transaction appends to one file, readers and the writer never wait for each other. Not synced
/// at each row, so power may take the newest rows, never the file: the store adds them again from the folders. All of
/// SQLite's memory comes from one block of kHeapBytes, taken when the first catalogue is opened; a board touches half a
/// MiB of it, a reader that keeps rows in memory a tenth of a KiB for each.
class Catalogue
{
public:
    static constexpr std::size_t kHeapBytes = std::size_t{8} << 20;

    enum class Access
    {
        kRead,  ///< the file must be there
        kWrite, ///< made if it is missing
    };

    /// `path`: the file; ":memory:" for one that is gone afterwards. `vfs`: SQLite's name of the way to the disk, null:
    /// the usual one. Fault::kBadData: no catalogue, damaged, or of a later version (remedy: verify --repair,
    /// which must remove `path` with -wal, -shm and -journal behind it); kNoInput: not there; kIoError: full,
    /// read-only, failed.
    static Result<std::unique_ptr<Catalogue>> open(const std::string& path, Access access, const char* vfs = nullptr);
    virtual ~Catalogue() = default;

    /// New, or instead of the row of this sequence; text is made printable (dicot/base/printable.h). Fault::kSoftware:
    /// a number that no row has.
    virtual Status put(const SlotRow& row) = 0;
    virtual Result<std::optional<SlotRow>> find(std::int64_t sequence) = 0;
    virtual Result<std::int64_t> last_sequence() = 0; ///< 0: no row
    /// In ascending order of sequence until `visit` returns false.
    virtual Status for_each(const SlotQuery& query, FunctionRef<bool(const SlotRow&)> visit) = 0;
    /// The newest row that was planned for `since_us` or later on a clock that was not known to be wrong.
    virtual Result<std::optional<SlotRow>> newest_planned(std::int64_t since_us) = 0;
    virtual Result<SlotTotals> totals() = 0;
    virtual Result<SlotPace> pace() = 0;

    /// Between them, all rows or none; faster for many rows.
    virtual Status begin() = 0;
    virtual Status commit() = 0;
    /// What was put so far outlives the power.
    virtual Status sync() = 0;
    /// SQLite's integrity_check, and every value in its range. Fault::kBadData with the first complaint.
    virtual Status check() = 0;

    /// How much of kHeapBytes SQLite ever used, all catalogues of this process together.
    static std::size_t peak_heap_bytes() noexcept;
};

} // namespace dicot
