#include "dicot/shelf/snapshot_shelf.h"

#include "dicot/base/arena.h"
#include "dicot/store/store.h"

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <cstring>

namespace dicot {
namespace {

ShortText<63> path_of(const SnapshotName& name)
{
    return folder_of(name.sequence, name.began_us);
}

Status not_there(std::int64_t sequence)
{
    return failure(Fault::kNoInput, "there is no snapshot %" PRId64, sequence);
}

} // namespace

SnapshotShelf::Room SnapshotShelf::lay_out(Arena& arena, const Limits& limits) noexcept
{
    Room room;
    room.entries = arena.take<ShelfEntry>(ShelfIndex::room_for(limits.snapshots));
    room.days = arena.take<ShelfDay>(limits.days);
    return room;
}

std::size_t SnapshotShelf::bytes_for(const Limits& limits) noexcept
{
    Arena measuring;
    (void)lay_out(measuring, limits);
    return measuring.peak();
}

SnapshotShelf::SnapshotShelf(Medium& medium, const Limits& limits, std::span<std::byte> memory,
                             std::int64_t (*clock_us)()) noexcept
    : SnapshotShelf(
          medium,
          [&] {
              Arena arena(memory);
              return lay_out(arena, limits);
          }(),
          limits.snapshots, clock_us)
{
}

SnapshotShelf::SnapshotShelf(Medium& medium, const Room& room, std::size_t limit, std::int64_t (*clock_us)()) noexcept
    : medium_(medium), day_room_(room.days), index_(room.entries, limit), clock_us_(clock_us)
{
}

ShelfDay* SnapshotShelf::find_day(std::uint32_t day) const noexcept
{
    const std::span<ShelfDay> days = shelf_days();
    const auto at = std::ranges::lower_bound(days, day, {}, &ShelfDay::day);
    return at != days.end() && at->day == day ? &*at : nullptr;
}

void SnapshotShelf::days(FunctionRef<bool(std::uint32_t day)> visit) const
{
    for (const ShelfDay& day : shelf_days())
        if (day.snapshots > 0 && !visit(day.day))
            return;
}

bool SnapshotShelf::has_day(std::uint32_t day) const noexcept
{
    const ShelfDay* const known = find_day(day);
    return known != nullptr && known->snapshots > 0;
}

void SnapshotShelf::snapshots_of_day(std::uint32_t day, FunctionRef<bool(const SnapshotName&, int files)> visit)
{
    for (ShelfEntry& entry : index_.entries())
        if (entry.day == day && look_at(entry) && !visit(entry.name(), entry.files))
            return;
}

void SnapshotShelf::snapshots(std::int64_t first_sequence, FunctionRef<bool(const SnapshotName&, int files)> visit)
{
    for (ShelfEntry& entry : index_.entries())
        if (entry.sequence >= first_sequence && look_at(entry) && !visit(entry.name(), entry.files))
            return;
}

std::optional<SnapshotName> SnapshotShelf::find(std::int64_t sequence)
{
    ShelfEntry* const entry = index_.find(sequence);
    return entry != nullptr && look_at(*entry) ? std::optional{entry->name()} : std::nullopt;
}

std::optional<std::int64_t> SnapshotShelf::latest_before(std::int64_t end_us) const noexcept
{
    std::optional<std::int64_t> latest;
    for (const ShelfEntry& entry : index_.entries())
        if (const std::int64_t began_us = entry.name().began_us; began_us < end_us)
            latest = std::max(latest.value_or(began_us), began_us);
    return latest;
}

bool SnapshotShelf::look_at(ShelfEntry& entry)
{
    return entry.files != ShelfEntry::kDamaged &&
           (entry.files != ShelfEntry::kNotCounted || files(entry.sequence).ok());
}

Result<const SnapshotFiles*> SnapshotShelf::files(std::int64_t sequence)
{
    ShelfEntry* const entry = index_.find(sequence);
    if (entry == nullptr || entry->files == ShelfEntry::kDamaged)
        return not_there(sequence);
    if (looked_at_ == sequence)
        return &files_;
    forget_files();
    const Result<SnapshotFiles> read = files_of_snapshot(medium_, path_of(entry->name()).c_str());
    if (read.status().fault() == Fault::kBadData) {
        entry->untold = entry->untold || entry->files == ShelfEntry::kNotCounted; // it was never shown
        entry->files = ShelfEntry::kDamaged;
        ++hidden_.damaged;
        if (ShelfDay* const day = find_day(entry->day); day != nullptr && day->snapshots > 0)
            --day->snapshots;
        return failure(Fault::kNoInput, "%s", read.status().message());
    }
    TRY(read.status());
    files_ = read.value();
    looked_at_ = sequence;
    entry->files = static_cast<std::uint8_t>(files_.count);
    return &files_;
}

Status SnapshotShelf::open_file(std::int64_t sequence, int member)
{
    const SnapshotFiles* const known = TRY(files(sequence));
    const bool is_sums = member == kSumsMember;
    if (!is_sums && (member < 0 || member >= known->count))
        return failure(Fault::kNoInput, "snapshot %" PRId64 " has no file %d", sequence, member);
    const StoredFile file =
        is_sums ? StoredFile{kSums, known->sums_bytes} : known->all()[static_cast<std::size_t>(member)];
    char path[128];
    std::snprintf(path, sizeof path, "%s/%s", path_of(index_.find(sequence)->name()).c_str(), file.name.c_str());
    close();
    std::uint64_t bytes = 0;
    if (const Errno opened = medium_.open(path, open_.file, bytes); !opened.ok()) {
        forget_files();
        TRY(files(sequence)); // gone, or damaged?
        return failure(Fault::kIoError, "%s: it cannot be opened (%s)", path, strerrordesc_np(opened.number()));
    }
    open_.sequence = sequence;
    open_.member = member;
    if (bytes == file.bytes)
        return {};
    close();
    forget_files();
    return failure(Fault::kIoError, "%s: it is not as long as it was", path);
}

Status SnapshotShelf::read(std::int64_t sequence, int member, std::uint64_t offset, std::span<std::byte> into,
                           std::size_t& got)
{
    got = 0;
    if (index_.find(sequence) == nullptr)
        return not_there(sequence);
    if (open_.sequence != sequence || open_.member != member)
        TRY(open_file(sequence, member));
    open_.used = true;
    const Errno outcome = medium_.read_at(open_.file, offset, into, got);
    if (outcome.ok())
        return {};
    close();
    got = 0;
    return failure(Fault::kIoError, "snapshot %" PRId64 ": reading failed (%s)", sequence,
                   strerrordesc_np(outcome.number()));
}

void SnapshotShelf::close() noexcept
{
    if (open_.sequence != 0)
        (void)medium_.close(open_.file);
    open_.sequence = 0;
}

} // namespace dicot
