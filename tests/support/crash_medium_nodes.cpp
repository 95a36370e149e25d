// The bytes of files, by the number of their node.
#include "crash_medium.h"

#include <algorithm>
#include <cerrno>
#include <utility>

namespace dicot::test {

int CrashMedium::find_file(const char* path) const
{
    const Place place = place_of(path);
    const bool found = place.error.ok() && place.node >= 0;
    return found && !now_.nodes[static_cast<std::size_t>(place.node)].folder ? place.node : -1;
}

Errno CrashMedium::write_at(int number, std::uint64_t offset, std::span<const std::byte> bytes)
{
    Errno error = strike(Touch::kGrow);
    if (error.ok() && bytes.empty())
        return {};
    const std::uint64_t used = now_.used_bytes();
    constexpr std::uint64_t kBlock = 4096;
    const std::uint64_t size = size_of(number);
    const std::uint64_t has = (size + kBlock - 1) / kBlock * kBlock;
    const std::uint64_t room = has + (capacity_ - std::min(capacity_, used)) / kBlock * kBlock;
    std::size_t fits = bytes.size();
    if (offset + fits > room) {
        error = error.ok() ? ENOSPC : error;
        fits = static_cast<std::size_t>(room - std::min(room, offset));
    } else if (!error.ok()) {
        fits /= 2;
    }
    // A write that fails may have begun.
    if (fits != 0 && error.number() != EROFS) {
        Change change;
        change.kind = Change::Kind::kWrite;
        change.node = number;
        change.offset = offset;
        change.bytes.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(fits));
        note(std::move(change));
    }
    return error;
}

Errno CrashMedium::read_node(int number, std::uint64_t offset, std::span<std::byte> into, std::size_t& got)
{
    got = 0;
    if (const Errno error = strike(Touch::kRead); !error.ok())
        return error;
    const CardBytes& bytes = node(number).bytes;
    const auto from = static_cast<std::size_t>(std::min<std::uint64_t>(offset, bytes.size()));
    got = std::min(into.size(), bytes.size() - from);
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(from), got, into.begin());
    return {};
}

Errno CrashMedium::truncate(int number, std::uint64_t size)
{
    if (const Errno error = strike(Touch::kChange); !error.ok())
        return error;
    Change change;
    change.kind = Change::Kind::kTruncate;
    change.node = number;
    change.offset = size;
    note(std::move(change));
    return {};
}

Errno CrashMedium::sync_file(int number)
{
    if (const Errno error = strike(Touch::kSync); !error.ok())
        return error;
    Change change;
    change.kind = Change::Kind::kSyncFile;
    change.node = number;
    note(std::move(change));
    return {};
}

} // namespace dicot::test
