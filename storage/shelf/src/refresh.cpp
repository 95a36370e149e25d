#include "day_name.h"

#include "dicot/base/utc_time.h"
#include "dicot/shelf/snapshot_shelf.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

namespace dicot {
namespace {

constexpr std::int64_t kCoarseUs = 3'000'000; ///< FAT's times are of two seconds, ext4's of a tick of the kernel

bool is_not_there(Errno outcome)
{
    return outcome.number() == ENOENT || outcome.number() == ENOTDIR || outcome.number() == ELOOP;
}

SnapshotShelf::Change change_of(const ShelfEntry& entry, bool added)
{
    const bool counted = entry.files != ShelfEntry::kDamaged;
    return {.day = entry.day, .snapshot = entry.name(), .files = counted ? entry.files : 0, .added = added};
}

SnapshotShelf::Change change_of(const ShelfDay& day, bool added)
{
    return {.day = day.day, .snapshot = {}, .files = 0, .added = added};
}

} // namespace

Status SnapshotShelf::refresh(FunctionRef<void(const Change&)> told)
{
    const auto changed = [&](const Change& change) {
        if (!is_first_)
            told(change);
    };
    TRY(list_days(changed));
    hidden_.unread_days = 0;
    for (ShelfDay& day : shelf_days())
        look_into(day, changed);
    tidy_up(changed);
    tell_damaged(changed);
    count();
    tell_days_gone(changed);
    tell_came(changed);
    list_again_what_was_beyond();
    if (!open_.used || index_.find(open_.sequence) == nullptr)
        close(); // what is deleted gives its room back
    open_.used = false;
    if (index_.find(looked_at_) == nullptr)
        forget_files();
    is_first_ = false;
    return {};
}

Status SnapshotShelf::list_days(FunctionRef<void(const Change&)> changed)
{
    beyond_limits_ = beyond_numbers_ = 0;
    for (ShelfDay& day : shelf_days())
        day.there = false;
    const Errno listed = medium_.list("", [&](const MediumEntry& entry) {
        const std::optional<std::int64_t> day =
            entry.kind == EntryKind::kFolder ? day_number(entry.name) : std::nullopt;
        if (day && *day < 0)
            ++beyond_numbers_;
        else if (day)
            take_day(static_cast<std::uint32_t>(*day), changed);
        return true;
    });
    if (listed.ok())
        return {};
    for (ShelfDay& day : shelf_days())
        day.there = day.stamped_us >= 0;
    drop_days_not_there();
    return failure(Fault::kIoError, "the folder of the snapshots cannot be listed (%s)",
                   strerrordesc_np(listed.number()));
}

void SnapshotShelf::take_day(std::uint32_t number, FunctionRef<void(const Change&)> changed)
{
    if (ShelfDay* known = find_day(number); known != nullptr) {
        known->there = true;
        return;
    }
    if (day_count_ == day_room_.size()) {
        ++beyond_limits_;
        if (day_count_ == 0 || number < day_room_.front().day)
            return;
        index_.lose_day(day_room_.front().day);
        if (day_room_.front().told)
            changed(change_of(day_room_.front(), false));
        std::copy(day_room_.begin() + 1, day_room_.end(), day_room_.begin());
        --day_count_;
    }
    const auto at = std::ranges::lower_bound(shelf_days(), number, {}, &ShelfDay::day);
    const auto place = day_room_.begin() + (at - shelf_days().begin());
    const auto end = day_room_.begin() + static_cast<std::ptrdiff_t>(day_count_);
    std::copy_backward(place, end, end + 1);
    *place = ShelfDay{};
    place->day = number;
    place->there = true;
    place->stamped_us = -1;
    ++day_count_;
}

void SnapshotShelf::drop_days_not_there() noexcept
{
    const std::span<ShelfDay> days = shelf_days();
    const auto end = std::remove_if(days.begin(), days.end(), [](const ShelfDay& day) { return !day.there; });
    day_count_ = static_cast<std::size_t>(end - days.begin());
}

void SnapshotShelf::look_into(ShelfDay& day, FunctionRef<void(const Change&)> changed)
{
    FolderStamp stamp;
    const Errno stamped = day.there ? medium_.stamp(day_name(day.day).c_str(), stamp) : Errno{ENOENT};
    if (is_not_there(stamped)) {
        day.there = false;
        index_.lose_day(day.day);
        return;
    }
    if (!stamped.ok()) {
        ++hidden_.unread_days;
        return;
    }
    const std::int64_t now_us = clock_us_();
    if (day.stamped_us < 0 || stamp != day.stamp) {
        day.stamp = stamp;
        day.stamped_us = now_us;
        day.listed = day.settled = false;
    }
    const bool is_late = now_us - day.stamped_us >= kCoarseUs;
    if (!day.listed || (!day.settled && is_late)) {
        list_day(day, changed);
        day.settled = day.listed && is_late;
    }
}

void SnapshotShelf::list_day(ShelfDay& day, FunctionRef<void(const Change&)> changed)
{
    const UtcText path = day_name(day.day);
    day.beyond_limits = day.beyond_numbers = day.doubled = 0;
    index_.begin_day(day.day);
    const Errno listed = medium_.list(path.c_str(), [&](const MediumEntry& entry) {
        const auto name = entry.kind == EntryKind::kFolder ? parse_snapshot_name(entry.name) : std::nullopt;
        if (!name || utc_day(name->began_us) != path)
            return true;
        if (!ShelfIndex::fits(*name)) {
            ++day.beyond_numbers;
        } else if (!index_.note(*name)) {
            tidy_up(changed);
            (void)index_.note(*name);
        }
        return true;
    });
    day.listed = listed.ok();
    index_.end_day(day.day, listed.ok());
    if (!listed.ok())
        ++hidden_.unread_days;
}

void SnapshotShelf::tidy_up(FunctionRef<void(const Change&)> changed)
{
    index_.tidy_up([&](const ShelfEntry& entry, ShelfIndex::Left why) {
        ShelfDay* const day = find_day(entry.day);
        if (why == ShelfIndex::Left::kGone)
            some_left_ = true;
        else if (day != nullptr)
            ++(why == ShelfIndex::Left::kDoubled ? day->doubled : day->beyond_limits);
        if (!entry.untold)
            changed(change_of(entry, false));
    });
}

void SnapshotShelf::tell_damaged(FunctionRef<void(const Change&)> changed)
{
    for (ShelfEntry& entry : index_.entries()) {
        if (entry.files != ShelfEntry::kDamaged || entry.untold)
            continue;
        changed(change_of(entry, false));
        entry.untold = true;
    }
}

void SnapshotShelf::count() noexcept
{
    hidden_.beyond_limits = beyond_limits_;
    hidden_.beyond_numbers = beyond_numbers_;
    hidden_.doubled = hidden_.damaged = 0;
    for (ShelfDay& day : shelf_days()) {
        day.snapshots = 0;
        hidden_.beyond_limits += day.beyond_limits;
        hidden_.beyond_numbers += day.beyond_numbers;
        hidden_.doubled += day.doubled;
    }
    for (const ShelfEntry& entry : index_.entries()) {
        if (entry.files == ShelfEntry::kDamaged)
            ++hidden_.damaged;
        else if (ShelfDay* day = find_day(entry.day); day != nullptr)
            ++day->snapshots;
    }
}

void SnapshotShelf::tell_days_gone(FunctionRef<void(const Change&)> changed)
{
    for (ShelfDay& day : shelf_days()) {
        if (day.snapshots > 0 || !day.told)
            continue;
        changed(change_of(day, false));
        day.told = false;
    }
    drop_days_not_there();
}

void SnapshotShelf::tell_came(FunctionRef<void(const Change&)> changed)
{
    for (ShelfEntry& entry : index_.entries()) {
        ShelfDay* const day = find_day(entry.day);
        // At the start nobody knows of any, and 10,000 are looked at when somebody asks.
        if (!entry.untold || day == nullptr || (!is_first_ && !look_at(entry)))
            continue;
        if (!day->told)
            changed(change_of(*day, true));
        changed(change_of(entry, true));
        day->told = true;
        entry.untold = false;
    }
}

void SnapshotShelf::list_again_what_was_beyond() noexcept
{
    if (!some_left_)
        return;
    some_left_ = false;
    for (ShelfDay& day : shelf_days())
        day.listed = day.listed && day.beyond_limits == 0 && day.doubled == 0;
}

} // namespace dicot
