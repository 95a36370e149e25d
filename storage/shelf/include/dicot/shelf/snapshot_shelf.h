// What stands complete in one board's store, for those who only look: hosts.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/function_ref.h"
#include "dicot/base/status.h"
#include "dicot/medium/medium.h"
#include "dicot/shelf/shelf_index.h"
#include "dicot/store/snapshot_files.h"
#include "dicot/store/snapshot_name.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace dicot {

/// A day's folder, as it was listed last.
struct ShelfDay
{
    std::uint32_t day;                                    ///< since 1970
    std::uint32_t snapshots;                              ///< that are shown
    std::uint32_t beyond_limits, beyond_numbers, doubled; ///< that are not: SnapshotShelf::Hidden
    bool there;                                           ///< as the store's folder was listed last
    bool listed;                                          ///< since it has this stamp
    bool settled;                                         ///< so late that nothing can have changed under it since
    bool told;                                            ///< somebody may know of it
    FolderStamp stamp;
    std::int64_t stamped_us; ///< when this stamp was first seen; -1: none was
};

/// An index of the folders' names, without the catalogue: a snapshot is shown when it is in its place, which the rename
/// made complete, and no longer when it has left it. What it shows changes in refresh() alone, except that a snapshot
/// that turns out to be damaged when it is first looked at is passed over from then on. Not for several threads at
/// once; no heap.
class SnapshotShelf
{
public:
    struct Limits
    {
        std::size_t snapshots = 65'536; ///< shown at most: the newest by number
        std::size_t days = 2'048;       ///< looked at, at most: the latest
    };
    /// What it is to be lent; aligned to 64.
    static std::size_t bytes_for(const Limits& limits) noexcept;

    /// `clock_us`: a time that never jumps, as monotonic_us().
    SnapshotShelf(Medium& medium, const Limits& limits, std::span<std::byte> memory,
                  std::int64_t (*clock_us)()) noexcept;
    SnapshotShelf(const SnapshotShelf&) = delete;
    SnapshotShelf& operator=(const SnapshotShelf&) = delete;
    ~SnapshotShelf() { close(); }

    /// Something came or went.
    struct Change
    {
        std::uint32_t day = 0;                ///< since 1970
        std::optional<SnapshotName> snapshot; ///< none: the day's folder
        int files = 0; ///< of a snapshot, without SHA256SUMS; 0 of one that went and that nobody looked at
        bool added = false;
    };
    /// Lists the store's folder, and the days in it that changed; the first time all of them, of which it tells
    /// nothing. A day comes before its snapshots and goes after them. Fault::kIoError: the store's folder cannot be
    /// listed, and nothing changed.
    Status refresh(FunctionRef<void(const Change&)> changed);

    static constexpr int kSumsMember = -1; ///< of read(): SHA256SUMS

    /// What is there and not shown.
    struct Hidden
    {
        std::size_t beyond_limits = 0;  ///< snapshots, and days, that are older than what fits
        std::size_t beyond_numbers = 0; ///< as the last listing saw it: numbers above kMostSequence, days before 1970
        std::size_t doubled = 0;        ///< a number that another folder has too: the one that began first is shown
        std::size_t damaged = 0;        ///< so far
        std::size_t unread_days = 0;    ///< cannot be listed now: what was known of them is still shown
    };
    const Hidden& hidden() const noexcept { return hidden_; }

    /// With a snapshot that is shown, ascending, until `visit` returns false.
    void days(FunctionRef<bool(std::uint32_t day)> visit) const;
    bool has_day(std::uint32_t day) const noexcept;
    /// In ascending order of numbers; looks at each that nobody has looked at so far, and passes over those damaged, or
    /// gone, or not readable now. `files`: without SHA256SUMS.
    void snapshots_of_day(std::uint32_t day, FunctionRef<bool(const SnapshotName&, int files)> visit);
    void snapshots(std::int64_t first_sequence, FunctionRef<bool(const SnapshotName&, int files)> visit);
    /// None: not shown. Looks at it if nobody has.
    std::optional<SnapshotName> find(std::int64_t sequence);
    /// When the snapshot began that began last, of those that began before `end_us`.
    std::optional<std::int64_t> latest_before(std::int64_t end_us) const noexcept;

    /// Good until another snapshot is looked at. Fault::kNoInput: not there, or not any more, or damaged; kIoError.
    Result<const SnapshotFiles*> files(std::int64_t sequence);
    /// From `offset` on, fewer bytes only at the end. `member`: of files(), or kSumsMember. The file
    /// stays open for the next read: a snapshot that is deleted meanwhile can be read to its file's end, until
    /// refresh() sees that it has gone. Faults as files().
    Status read(std::int64_t sequence, int member, std::uint64_t offset, std::span<std::byte> into, std::size_t& got);
    /// The next files() reads again, PULLED too.
    void forget_files() noexcept { looked_at_ = 0; }

private:
    struct Room
    {
        std::span<ShelfEntry> entries;
        std::span<ShelfDay> days;
    };
    struct OpenFile
    {
        std::int64_t sequence = 0; ///< 0: none
        int member = 0;
        Medium::File file = 0;
        bool used = false; ///< since the last refresh()
    };

    static Room lay_out(Arena& arena, const Limits& limits) noexcept;
    SnapshotShelf(Medium& medium, const Room& room, std::size_t limit, std::int64_t (*clock_us)()) noexcept;

    std::span<ShelfDay> shelf_days() const noexcept { return day_room_.first(day_count_); }
    ShelfDay* find_day(std::uint32_t day) const noexcept;
    Status list_days(FunctionRef<void(const Change&)> changed);
    void take_day(std::uint32_t day, FunctionRef<void(const Change&)> changed);
    void drop_days_not_there() noexcept;
    void look_into(ShelfDay& day, FunctionRef<void(const Change&)> changed);
    void list_day(ShelfDay& day, FunctionRef<void(const Change&)> changed);
    void tidy_up(FunctionRef<void(const Change&)> changed);
    void tell_came(FunctionRef<void(const Change&)> changed);
    void tell_days_gone(FunctionRef<void(const Change&)> changed);
    void tell_damaged(FunctionRef<void(const Change&)> changed);
    void count() noexcept;
    void list_again_what_was_beyond() noexcept;
    bool look_at(ShelfEntry& entry);
    Status open_file(std::int64_t sequence, int member);
    void close() noexcept;

    Medium& medium_;
    std::span<ShelfDay> day_room_;
    ShelfIndex index_;
    std::int64_t (*clock_us_)();
    std::size_t day_count_ = 0;
    std::size_t beyond_limits_ = 0, beyond_numbers_ = 0; ///< days
    bool is_first_ = true;
    bool some_left_ = false; ///< so there is room for what was beyond the limits
    Hidden hidden_;
    std::int64_t looked_at_ = 0; ///< whose files_ are; 0: none
    SnapshotFiles files_;
    OpenFile open_;
};

/// As SnapshotShelf::latest_before(), by the folders' names alone. Fault::kIoError: the store's folder, or a day,
/// cannot be listed.
Result<std::optional<std::int64_t>> latest_in_store(Medium& medium, std::int64_t end_us);

} // namespace dicot
