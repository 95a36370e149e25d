// What stands complete in one board's store, for those who only look: hosts.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/base/status.h"
#include "dicot/medium/medium.h"
#include "dicot/store/snapshot_files.h"
#include "dicot/store/snapshot_name.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace dicot {

struct ShelfEntry;
struct ShelfDay;

/// An index of the folders' names, without the catalogue: a snapshot is shown when it is in its place, which the rename
/// made complete, and no longer when it has left it. What it shows changes in refresh() alone, except that a snapshot
/// that turns out to be damaged is no longer shown. Not for several threads at once; no heap.
class SnapshotShelf
{
public:
    /// Those of a number above are not shown, and counted.
    static constexpr std::int64_t kMostSequence = (std::int64_t{1} << 27) - 1;

    struct Room
    {
        std::span<ShelfEntry> entries;
        std::span<ShelfDay> days;
    };
    struct Limits
    {
        std::size_t snapshots = 32'768; ///< shown at most: the newest by number
        std::size_t days = 4'096;       ///< looked at, at most: the latest
    };
    /// What open() is to be lent for it; aligned as operator new does.
    static std::size_t bytes_for(const Limits& limits) noexcept;

    /// `clock_us`: time that never jumps (monotonic_us).
    SnapshotShelf(Medium& medium, const Limits& limits, std::span<std::byte> memory,
                  std::int64_t (*clock_us)()) noexcept;
    SnapshotShelf(const SnapshotShelf&) = delete;
    SnapshotShelf& operator=(const SnapshotShelf&) = delete;
    ~SnapshotShelf();

    /// What is there but not shown, as the last refresh() saw it.
    struct Hidden
    {
        std::size_t beyond_limits = 0;  ///< snapshots and days that are older than what fits
        std::size_t beyond_numbers = 0; ///< numbers above kMostSequence, days before 1970
        std::size_t doubled = 0;        ///< a number that another folder has too: the one that began first is shown
        std::size_t damaged = 0;        ///< so far
        std::size_t unread_days = 0;    ///< could not be listed: what was known of them is still shown
    };
    const Hidden& hidden() const noexcept { return hidden_; }
    std::size_t size() const noexcept { return used_; } ///< with those damaged

    /// Something came or went.
    struct Change
    {
        std::int64_t day = 0;                 ///< since 1970
        std::optional<SnapshotName> snapshot; ///< none: the day's folder
        int files = 0; ///< of a snapshot, without SHA256SUMS; 0 of one that went and was never looked at
        bool added = false;
    };
    /// Lists the store's folder, and the days in it that changed. The first time all of them, and tells nothing of it.
    /// A day comes before its snapshots and goes after them. Fault::kIoError: the store's folder cannot be listed, and
    /// nothing changed.
    Status refresh(FunctionRef<void(const Change&)> changed);

    /// Days with a snapshot that is shown, ascending, since 1970, until `visit` returns false.
    Status days(FunctionRef<bool(std::int64_t day)> visit);
    bool has_day(std::int64_t day) const noexcept;
    /// Ascending by number; looks at each that nobody has looked at so far, and passes over those damaged. `files`:
    /// without SHA256SUMS. Fault::kIoError: nobody can say of one.
    Status snapshots_of_day(std::int64_t day, FunctionRef<bool(const SnapshotName&, int files)> visit);
    Status snapshots(std::int64_t first_sequence, FunctionRef<bool(const SnapshotName&, int files)> visit);

    std::optional<SnapshotName> find(std::int64_t sequence) const noexcept;
    /// The time of the snapshot that began last by its clock; none: there is none.
    std::optional<std::int64_t> latest_us() const noexcept;

    /// Until the next call of any of these. Fault::kNoInput: not there, or not any more, or damaged; kIoError.
    Result<const SnapshotFiles*> files(std::int64_t sequence);
    /// From `offset` on, fewer only at the end. `member`: of files(); count: SHA256SUMS. The file stays open for the
    /// next read, and so can be read to its end when the snapshot is deleted meanwhile, until refresh() sees that.
    Status read(std::int64_t sequence, int member, std::uint64_t offset, std::span<std::byte> into, std::size_t& got);
    /// Reads PULLED again.
    void forget_files() noexcept { looked_at_ = 0; }

private:
    struct Open
    {
        std::int64_t sequence = 0; ///< 0: none
        int member = 0;
        Medium::File file = 0;
        bool used = false; ///< since the last refresh()
    };

    Medium& medium_;
    Room room_;
    std::size_t limit_;
    std::int64_t (*clock_us_)();
    std::size_t used_ = 0, day_count_ = 0;
    bool is_first_ = true;
    Hidden hidden_;
    std::int64_t looked_at_ = 0; ///< whose files_ are; 0: none
    SnapshotFiles files_;
    Open open_;
};

/// The time of the snapshot that began last, by the folders' names alone; none: there is none. Fault::kIoError.
Result<std::optional<std::int64_t>> latest_in_store(Medium& medium);

} // namespace dicot
