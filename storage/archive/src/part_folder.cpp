#include "part_folder.h"

#include "dicot/base/utc_time.h"
#include "dicot/os/sha256.h"
#include "dicot/os/shown_path.h"
#include "dicot/pull_archive/board_archive.h"

#include <algorithm>
#include <cerrno>

namespace dicot {
namespace {

PartOutcome of_source(const Status& status)
{
    return {status, true};
}

} // namespace

PartFolder::PartFolder(Medium& medium, const ReadingDesk& desk, std::span<std::byte> piece, const SnapshotName& name)
    : medium_(medium), desk_(desk), piece_(piece), name_(name), part_(join(kIncoming, snapshot_name(name).view()))
{
}

PartOutcome PartFolder::fill(PullSource& source, const Offer& offer, Arrived arrived)
{
    if (const Status ready = prepare(offer); !ready.ok())
        return {ready};
    const auto sums = offer.sums.all();
    for (std::size_t k = 0; k < sums.size(); ++k)
        if (const PartOutcome taken = take_file(source, offer.files[k], sums[k], arrived); !taken.status.ok())
            return taken;
    const Result<SlotRow> row = row_of(medium_, part_, name_, desk_);
    if (row.ok() || !is_damage(row.status()))
        return {row.status()};
    return {row.status(), true, true};
}

Status PartFolder::begin()
{
    const Errno made = medium_.make_folder(part_.c_str());
    return made.number() == EEXIST ? Status{} : on_disk(made, part_.c_str(), "making a folder");
}

/// With the digests of this offer in it, and nothing that they do not name.
Status PartFolder::prepare(const Offer& offer)
{
    TRY(begin());
    TRY(write_sums(offer));
    TRY(remove_strangers(offer));
    std::uint64_t there_bytes = 0;
    for (const Sum& sum : offer.sums.all())
        there_bytes += size_of(join(part_.view(), sum.name.view()));
    return has_room(medium_, offer.bytes - std::min(offer.bytes, there_bytes));
}

/// The files are hashed anyway, so they stay whatever was there before.
Status PartFolder::write_sums(const Offer& offer)
{
    const StorePath path = join(part_.view(), kSums);
    const Result<ReadSums> there = read_sums(medium_, part_);
    if (there.ok() && there.value().sha256 == offer.sums_sha256)
        return {};
    TRY(begin_anew(path));
    Medium::File file = 0;
    TRY(on_disk(medium_.create(path.c_str(), file), path.c_str(), "making it"));
    const Errno written = medium_.write(file, std::as_bytes(std::span(offer.sums_text)));
    const Errno closed = medium_.close(file);
    return on_disk(written.ok() ? closed : written, path.c_str(), "writing");
}

Status PartFolder::remove_strangers(const Offer& offer)
{
    for (;;) {
        StorePath stranger;
        const Errno listed = medium_.list(part_.c_str(), [&](const MediumEntry& entry) {
            if (entry.kind == EntryKind::kFile && (entry.name == kSums || offer.sums.find(entry.name) != nullptr))
                return true;
            stranger = join(part_.view(), entry.name);
            return false;
        });
        TRY(on_disk(listed, part_.c_str(), "listing it"));
        if (stranger.empty())
            return {};
        TRY(on_disk(medium_.remove_file(stranger.c_str()), stranger.c_str(), "removing it"));
    }
}

/// A power cut leaves zeros in a file that grew, and another source may have begun it: so what is there has a second
/// chance from its first byte on.
PartOutcome PartFolder::take_file(PullSource& source, const OfferedFile& file, const Sum& sum, Arrived arrived)
{
    constexpr int kTries = 2;
    const StorePath path = join(part_.view(), sum.name.view());
    for (int k = 0; k < kTries; ++k) {
        if (k > 0 || size_of(path) > file.bytes)
            if (const Status anew = begin_anew(path); !anew.ok())
                return {anew};
        Sha256Stream hash;
        if (const PartOutcome grown = grow_file(source, file, hash, arrived); !grown.status.ok())
            return grown;
        if (sum.sha256.view() == hex_of(hash.finish()).data())
            return {};
    }
    return {failure(Fault::kBadData, "%s: its bytes are not those that were stored", sum.name.c_str()), true, true};
}

PartOutcome PartFolder::grow_file(PullSource& source, const OfferedFile& file, Sha256Stream& hash, Arrived arrived)
{
    const StorePath path = join(part_.view(), file.name.view());
    std::uint64_t size = 0;
    const Status there = read_file(medium_, path, BoardArchive::kMostFileBytes, piece_, [&](auto bytes) {
        hash.update(bytes);
        size += bytes.size();
    });
    Medium::File grown = 0;
    Errno opened = 0;
    if (there.fault() == Fault::kNoInput)
        opened = medium_.create(path.c_str(), grown);
    else if (!there.ok())
        return {there};
    else if (size == file.bytes)
        return {};
    else
        opened = medium_.append(path.c_str(), grown, size);
    if (!opened.ok())
        return {on_disk(opened, path.c_str(), "opening it")};
    const PartOutcome outcome = read_on(source, file, size, grown, hash, arrived);
    const Status closed = on_disk(medium_.close(grown), path.c_str(), "closing it");
    return outcome.status.ok() ? PartOutcome{closed} : outcome;
}

PartOutcome PartFolder::read_on(PullSource& source, const OfferedFile& file, std::uint64_t from, Medium::File into,
                                Sha256Stream& hash, Arrived arrived)
{
    while (from < file.bytes) {
        const auto piece =
            piece_.first(static_cast<std::size_t>(std::min<std::uint64_t>(piece_.size(), file.bytes - from)));
        const Result<std::size_t> read = source.read(file, from, piece);
        if (!read.ok())
            return of_source(read.status());
        if (read.value() == 0 || read.value() > piece.size())
            return of_source(failure(Fault::kBadData, "%s: it ends too early", file.name.c_str()));
        const auto bytes = piece.first(read.value());
        hash.update(bytes);
        if (const Errno written = medium_.write(into, bytes); !written.ok())
            return {on_disk(written, join(part_.view(), file.name.view()).c_str(), "writing")};
        from += bytes.size();
        if (!arrived(bytes.size()))
            return {failure(Fault::kTryAgain, "stopped; the next pull goes on there")};
    }
    return {};
}

Status PartFolder::begin_anew(const StorePath& path)
{
    const Errno removed = medium_.remove_file(path.c_str());
    return removed.number() == ENOENT ? Status{} : on_disk(removed, path.c_str(), "removing it");
}

std::uint64_t PartFolder::size_of(const StorePath& path)
{
    Medium::File file = 0;
    std::uint64_t size = 0;
    if (!medium_.open(path.c_str(), file, size).ok())
        return 0;
    (void)medium_.close(file);
    return size;
}

/// The order of all that makes a pulled snapshot durable stands here alone.
Status PartFolder::settle()
{
    const StorePath day = utc_day(name_.began_us).view();
    const StorePath target = folder_of(row_named(name_));
    const Errno made = medium_.make_folder(day.c_str());
    if (made.number() != EEXIST)
        TRY(on_disk(made, day.c_str(), "making a folder"));
    TRY(on_disk(medium_.sync_all(), part_.c_str(), "syncing")); // the day's name too
    TRY(on_disk(medium_.rename(part_.c_str(), target.c_str()), target.c_str(), "renaming"));
    const Status synced = on_disk(medium_.sync_folder(day.c_str()), day.c_str(), "syncing");
    if (!synced.ok()) // what may not last is not to be seen
        (void)medium_.rename(target.c_str(), part_.c_str());
    return synced;
}

Status PartFolder::let_go()
{
    TRY(empty_folder(medium_, part_));
    const Errno removed = medium_.remove_folder(part_.c_str());
    return removed.number() == ENOENT ? Status{} : on_disk(removed, part_.c_str(), "removing it");
}

} // namespace dicot
