#include "dicot/shelf/shelf_index.h"

#include <algorithm>
#include <tuple>

namespace dicot {
namespace {

constexpr std::int64_t kSecondUs = 1'000'000;
constexpr std::int64_t kDayS = 86'400;

auto place_of(const ShelfEntry& entry) noexcept
{
    return std::tuple{entry.sequence, entry.day, entry.second, entry.untold};
}

bool same_folder(const ShelfEntry& a, const ShelfEntry& b) noexcept
{
    return a.day == b.day && a.second == b.second;
}

} // namespace

SnapshotName ShelfEntry::name() const noexcept
{
    return {sequence, (day * kDayS + second) * kSecondUs};
}

bool ShelfIndex::fits(const SnapshotName& name) noexcept
{
    return name.sequence >= 1 && name.sequence <= kMostSequence && name.began_us >= 0;
}

void ShelfIndex::begin_day(std::uint32_t day) noexcept
{
    for (ShelfEntry& entry : used())
        if (entry.day == day)
            entry.seen = false;
}

bool ShelfIndex::note(const SnapshotName& name) noexcept
{
    const std::int64_t second = name.began_us / kSecondUs;
    const ShelfEntry noted{.sequence = static_cast<std::uint32_t>(name.sequence),
                           .day = static_cast<std::uint32_t>(second / kDayS),
                           .second = static_cast<std::uint32_t>(second % kDayS),
                           .files = ShelfEntry::kNotCounted,
                           .seen = true,
                           .untold = true,
                           .gone = false};
    if (ShelfEntry* known = find(name.sequence); known != nullptr && same_folder(*known, noted)) {
        known->seen = true;
        known->gone = false;
        return true;
    }
    if (used_ == room_.size())
        return false;
    room_[used_++] = noted;
    return true;
}

void ShelfIndex::end_day(std::uint32_t day, bool whole) noexcept
{
    if (whole) {
        for (ShelfEntry& entry : used())
            entry.gone = entry.gone || (entry.day == day && !entry.seen);
        return;
    }
    const auto came = [&](const ShelfEntry& entry) { return entry.day == day && entry.untold; };
    sorted_ -= static_cast<std::size_t>(std::ranges::count_if(entries(), came));
    const std::span<ShelfEntry> all = used();
    used_ = static_cast<std::size_t>(std::remove_if(all.begin(), all.end(), came) - all.begin());
}

void ShelfIndex::lose_day(std::uint32_t day) noexcept
{
    for (ShelfEntry& entry : used())
        entry.gone = entry.gone || entry.day == day;
}

void ShelfIndex::tidy_up(FunctionRef<void(const ShelfEntry&, Left)> left) noexcept
{
    const std::span<ShelfEntry> all = used();
    if (used_ == sorted_ && std::ranges::none_of(all, &ShelfEntry::gone))
        return;
    std::ranges::sort(all, {}, place_of);
    std::size_t kept = 0;
    for (const ShelfEntry& entry : all) {
        const bool is_double = kept > 0 && room_[kept - 1].sequence == entry.sequence;
        if (entry.gone)
            left(entry, Left::kGone);
        else if (!is_double)
            room_[kept++] = entry;
        else if (!same_folder(room_[kept - 1], entry)) // a listing may name one twice
            left(entry, Left::kDoubled);
    }
    const std::size_t too_many = kept - std::min(kept, limit_);
    for (const ShelfEntry& entry : room_.first(too_many))
        left(entry, Left::kTooMany);
    std::copy(room_.begin() + static_cast<std::ptrdiff_t>(too_many), room_.begin() + static_cast<std::ptrdiff_t>(kept),
              room_.begin());
    sorted_ = used_ = kept - too_many;
}

ShelfEntry* ShelfIndex::find(std::int64_t sequence) const noexcept
{
    const std::span<ShelfEntry> sorted = entries();
    const auto at = std::ranges::lower_bound(sorted, sequence, {}, &ShelfEntry::sequence);
    return at != sorted.end() && at->sequence == sequence ? &*at : nullptr;
}

} // namespace dicot
