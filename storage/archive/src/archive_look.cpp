#include "dicot/pull_archive/archive_look.h"

#include "board_notes.h"
#include "disk_words.h"

#include "snapshot_folder.h"

#include <algorithm>
#include <cerrno>
#include <vector>

namespace dicot {
namespace {

Result<std::vector<SnapshotName>> names_in(Medium& medium, FunctionRef<void(const Status&)> flawed)
{
    std::vector<SnapshotName> names;
    const bool all = TRY(for_each_folder(medium, [&](const StorePath&, const SnapshotName& name) {
        names.push_back(name);
        return true;
    }));
    if (!all)
        flawed(failure(Fault::kIoError, "a day's folder cannot be listed: what it holds is not counted"));
    std::ranges::sort(names, [](const SnapshotName& a, const SnapshotName& b) {
        return a.sequence != b.sequence ? a.sequence < b.sequence : a.began_us < b.began_us;
    });
    return names;
}

/// The folders in one of the rooms beside the days.
int folders_in(Medium& medium, const char* room, FunctionRef<void(const StorePath& folder)> visit)
{
    std::vector<StorePath> folders;
    (void)medium.list(room, [&](const MediumEntry& entry) {
        if (entry.kind == EntryKind::kFolder)
            folders.push_back(join(room, entry.name));
        return true;
    });
    for (const StorePath& folder : folders)
        visit(folder);
    return static_cast<int>(folders.size());
}

std::uint64_t bytes_in(Medium& medium, const StorePath& folder)
{
    std::vector<StorePath> files;
    (void)medium.list(folder.c_str(), [&](const MediumEntry& entry) {
        if (entry.kind == EntryKind::kFile)
            files.push_back(join(folder.view(), entry.name));
        return true;
    });
    std::uint64_t bytes = 0;
    for (const StorePath& path : files) {
        Medium::File file = 0;
        std::uint64_t size = 0;
        if (!medium.open(path.c_str(), file, size).ok())
            continue;
        bytes += size;
        (void)medium.close(file);
    }
    return bytes;
}

RecordFacts facts_of(const SlotRow& row)
{
    return {.sequence = row.sequence,
            .began_us = row.began_us,
            .due_us = row.due_us,
            .done = row.done,
            .reason = row.reason,
            .clock_trust = row.clock_trust,
            .points = row.points};
}

/// Every file, and that its number is nobody else's. The first flaw of each file is told.
bool is_right(Medium& medium, const SnapshotName& name, const ReadingDesk& desk, std::uint64_t& bytes,
              FunctionRef<void(const Status&)> found)
{
    const StorePath folder = folder_of(row_named(name));
    const Result<ReadSums> sums = read_sums(medium, folder);
    if (!sums.ok()) {
        found(sums.status());
        return false;
    }
    bool right = true;
    for (const Sum& sum : sums.value().sums.all())
        if (const Status flaw = check_file(medium, folder, sum, desk, bytes); !flaw.ok()) {
            found(flaw);
            right = false;
        }
    if (!right)
        return false;
    const Result<SlotRow> row = row_of(medium, folder, name, desk);
    if (!row.ok())
        found(row.status());
    return row.ok();
}

} // namespace

Result<ArchiveLook> look_at_archive(Medium& medium, FunctionRef<void(const RecordFacts&)> visit,
                                    FunctionRef<void(const Status&)> flawed)
{
    const ReadingDesk desk = TRY(ReadingDesk::make());
    ArchiveLook look;
    for (const SnapshotName& name : TRY(names_in(medium, flawed))) {
        look.here.add(name.sequence);
        ++look.snapshots;
        const Result<SlotRow> row = row_of(medium, folder_of(row_named(name)), name, desk);
        if (!row.ok()) {
            flawed(row.status());
            continue;
        }
        look.missed += row.value().done ? 0 : 1;
        look.bytes += static_cast<std::uint64_t>(row.value().bytes);
        look.newest = facts_of(row.value());
        visit(*look.newest);
    }
    look.incomplete = folders_in(medium, kIncoming,
                                 [&](const StorePath& folder) { look.incomplete_bytes += bytes_in(medium, folder); });
    look.in_quarantine = folders_in(medium, kQuarantine, [](const StorePath&) {});
    if (Result<std::string> serial = read_board(medium); serial.ok())
        look.serial = std::move(serial.value());
    if (auto last = read_last_pull(medium)) {
        look.pulled_us = last->pulled_us;
        look.had = std::move(last->had);
    }
    look.waiting = look.had.without(look.here);
    const std::int64_t last_here = look.here.empty() ? 0 : look.here.all().back().last;
    const std::int64_t last_there = look.had.empty() ? 0 : look.had.all().back().last;
    look.lost = look.here.absent(1, std::max(last_here, last_there)).without(look.had);
    return look;
}

Result<ArchiveCheck> check_archive(Medium& medium, FunctionRef<void(const Status&)> found,
                                   FunctionRef<bool(std::int64_t, std::int64_t)> progress)
{
    const ReadingDesk desk = TRY(ReadingDesk::make());
    ArchiveCheck check;
    const std::vector<SnapshotName> names = TRY(names_in(medium, [&](const Status& flaw) {
        ++check.damaged;
        found(flaw);
    }));
    const auto all = static_cast<std::int64_t>(names.size());
    for (std::size_t k = 0; k < names.size(); ++k) {
        if (!progress(check.snapshots, all))
            return failure(Fault::kTryAgain, "stopped after %lld of %lld snapshots",
                           static_cast<long long>(check.snapshots), static_cast<long long>(all));
        ++check.snapshots;
        bool right = is_right(medium, names[k], desk, check.bytes, found);
        if (k > 0 && names[k - 1].sequence == names[k].sequence) {
            found(
                failure(Fault::kBadData, "%s: another folder has its number", folder_of(row_named(names[k])).c_str()));
            right = false;
        }
        check.damaged += right ? 0 : 1;
    }
    (void)progress(all, all);
    return check;
}

} // namespace dicot
