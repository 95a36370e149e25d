// Names of snapshots in a table of fixed size, and what became of them since the last look.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/store/snapshot_name.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// One snapshot.
struct ShelfEntry
{
    static constexpr std::uint8_t kNotCounted = 0;
    static constexpr std::uint8_t kDamaged = 255;

    std::uint32_t sequence;
    std::uint32_t day;    ///< since 1970
    std::uint32_t second; ///< of the day
    std::uint8_t files;   ///< without SHA256SUMS; or one of the above
    bool seen;            ///< in the listing that is under way
    bool untold;          ///< nobody was told that it is there
    bool gone;            ///< leaves with the next tidy_up()

    SnapshotName name() const noexcept;
};
static_assert(sizeof(ShelfEntry) == 16);

/// Between two tidy_up() new entries stand behind the others in no order, which neither find() nor entries() sees.
class ShelfIndex
{
public:
    /// How many entries are to be lent for `limit` snapshots.
    static constexpr std::size_t room_for(std::size_t limit) noexcept { return limit + limit / 8 + 64; }

    /// `room`: room_for(limit).
    ShelfIndex(std::span<ShelfEntry> room, std::size_t limit) noexcept : room_(room), limit_(limit) {}

    /// A day is listed: begin, note each name, end. Names have passed fits().
    void begin_day(std::uint32_t day) noexcept;
    /// False: no room before tidy_up().
    bool note(const SnapshotName& name) noexcept;
    /// `whole`: it was listed to its end, so what was not seen is gone. Else what came new is forgotten again.
    void end_day(std::uint32_t day, bool whole) noexcept;
    /// Its folder is not there any more.
    void lose_day(std::uint32_t day) noexcept;

    enum class Left
    {
        kGone,    ///< from its place
        kTooMany, ///< older, by number, than what fits
        kDoubled, ///< another folder with its number began earlier
    };
    /// Sorts by number, one of each, the newest that fit.
    void tidy_up(FunctionRef<void(const ShelfEntry&, Left)> left) noexcept;

    /// In ascending order of numbers.
    std::span<ShelfEntry> entries() const noexcept { return room_.first(sorted_); }
    ShelfEntry* find(std::int64_t sequence) const noexcept;

    /// A number and a day that handles can hold.
    static bool fits(const SnapshotName& name) noexcept;
    static constexpr std::int64_t kMostSequence = (std::int64_t{1} << 27) - 1;

private:
    std::span<ShelfEntry> used() const noexcept { return room_.first(used_); }

    std::span<ShelfEntry> room_;
    std::size_t limit_;
    std::size_t sorted_ = 0, used_ = 0;
};

} // namespace dicot
