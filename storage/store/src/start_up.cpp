#include "start_up.h"

#include "incoming.h"

#include "dicot/os/shown_path.h"
#include "dicot/os/stage_watch.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>

namespace dicot {
namespace {

constexpr const char* kInterrupted = "interrupted: the power went, or dicot was ended, before the snapshot was stored";
constexpr std::size_t kMostLeftOvers = 64;
constexpr std::size_t kLongestName = 64;
constexpr std::uint64_t kBallastBytes = 256 * 1024;

/// A record that says no more than the folder's name does.
Status settle_interrupted(Medium& medium, const PartName& part, const ShortText<159>& cause)
{
    Incoming incoming(medium);
    incoming.adopt(part, false);
    TRY(incoming.take_back());
    RecordFacts facts;
    facts.sequence = part.name.sequence;
    facts.began_us = part.name.began_us;
    facts.due_us = part.due_us;
    char reason[256];
    std::snprintf(reason, sizeof reason, "%s%s%s", kInterrupted, cause.empty() ? "" : ": ", cause.c_str());
    facts.reason = reason;
    facts.clock_trust = "unknown";
    std::array<char, 1024> text{};
    const std::size_t bytes = write_plain_record(facts, "dicot " DICOT_VERSION, text);
    TRY(incoming.add(kRecord, [&](ByteSink& sink) { return sink.write(std::as_bytes(std::span(text).first(bytes))); }));
    return incoming.settle().status();
}

Status settle_whole(Medium& medium, const PartName& part)
{
    Incoming incoming(medium);
    incoming.adopt(part, true);
    return incoming.settle().status();
}

Status end_one(Medium& medium, Catalogue& catalogue, const StorePath& leaf, const ReadingDesk& desk,
               const ShortText<159>& cause, StartReport& report)
{
    const StorePath part = join(kIncoming, leaf.view());
    const auto planned = parse_part_name(leaf.view());
    if (!planned) {
        if (leaf.view().starts_with(kPulledMark)) // a mark that did not get to its place
            return on_card(medium.remove_file(part.c_str()), part.c_str(), "removing it");
        return quarantine(medium, part);
    }
    const SnapshotName& name = planned->name;
    const StorePath target = folder_of(name.sequence, name.began_us).view();
    if (is_there(medium, target.c_str()))
        return quarantine(medium, part);
    const bool whole = TRY(is_whole(medium, part, name, desk));
    const Status status = whole ? settle_whole(medium, *planned) : settle_interrupted(medium, *planned, cause);
    if (!status.ok())
        return status.fault() == Fault::kBadData ? quarantine(medium, part) : status;
    ++(whole ? report.finished : report.interrupted);
    return catalogue.put(TRY(row_of(medium, target, name, desk)));
}

Result<std::int64_t> highest_name(Medium& medium, const char* folder)
{
    std::int64_t highest = 0;
    const Errno listed = medium.list(folder, [&](const MediumEntry& entry) {
        // In quarantine names may have got an end.
        if (const auto part = parse_part_name(entry.name.substr(0, entry.name.find('.'))))
            highest = std::max(highest, part->name.sequence);
        return true;
    });
    TRY(on_card(listed, folder, "listing it"));
    return highest;
}

SlotRow unreadable_row(const SnapshotName& name)
{
    SlotRow row = row_named(name);
    row.reason = "its record cannot be read: dicot verify says why";
    row.clock_trust = "unknown";
    return row;
}

/// Also if that cannot be told.
bool may_have_mark(Medium& medium, const StorePath& folder)
{
    EntryKind kind{};
    return medium.kind_of(join(folder.view(), kPulledMark).c_str(), kind).number() != ENOENT;
}

} // namespace

Status make_rooms(Medium& medium)
{
    bool any_new = false;
    for (const char* const room : {kIncoming, kLeaving, kQuarantine}) {
        EntryKind kind{};
        const Errno there = medium.kind_of(room, kind);
        if (there.ok() && kind == EntryKind::kFolder)
            continue;
        if (there.ok()) { // somebody else's file or link, in the way
            const std::string aside = std::string(room) + ".strange";
            TRY(on_card(medium.rename(room, aside.c_str()), room, "moving it out of the way"));
        }
        any_new = true;
        TRY(make_folder(medium, room));
    }
    return any_new ? on_card(medium.sync_all(), "", "syncing") : Status{};
}

Result<std::unique_ptr<Catalogue>> open_catalogue(Medium& medium, const std::string& path, const char* vfs,
                                                  StartReport& report)
{
    report.catalogue_new = !is_there(medium, Store::kCatalogueName);
    auto opened = Catalogue::open(path, Catalogue::Access::kWrite, vfs);
    if (opened.ok() || opened.status().fault() != Fault::kBadData)
        return opened;
    for (const char* const end : {"", "-wal", "-shm", "-journal"}) {
        const StorePath file = (std::string(Store::kCatalogueName) + end).c_str();
        if (is_there(medium, file.c_str()))
            TRY(quarantine(medium, file));
    }
    report.catalogue_new = true;
    return Catalogue::open(path, Catalogue::Access::kWrite, vfs);
}

Result<bool> add_rows(Medium& medium, Catalogue& catalogue, const ReadingDesk& desk, StartReport& report,
                      std::int64_t& highest, Unreadable unreadable)
{
    TRY(catalogue.begin());
    bool all = true;
    Status status;
    const Result<bool> walked = for_each_folder(medium, [&](const StorePath& folder, const SnapshotName& name) {
        StageWatch::progress(); // thousands of folders take their time
        status = [&]() -> Status {
            highest = std::max(highest, name.sequence);
            std::optional<SlotRow> row = TRY(catalogue.find(name.sequence));
            if (!row) {
                const Result<SlotRow> fresh = row_of(medium, folder, name, desk);
                if (!fresh.ok()) { // damaged: verify names it
                    all = all && is_damage(fresh.status());
                    return unreadable == Unreadable::kNamed ? catalogue.put(unreadable_row(name)) : Status{};
                }
                ++report.rows_added;
                all = all && (fresh.value().pulled_us || !may_have_mark(medium, folder));
                return catalogue.put(fresh.value());
            }
            if (row->began_us != name.began_us)
                return {};
            SlotRow now = *row;
            now.kept = Kept::kHere;
            if (!now.pulled_us)
                now.pulled_us = pulled_time(medium, folder, now.sums);
            all = all && (now.pulled_us || !may_have_mark(medium, folder));
            return now == *row ? Status{} : catalogue.put(now);
        }();
        return status.ok();
    });
    // Also after a failure: each row is right, and nothing else may come into this transaction.
    const Status committed = catalogue.commit();
    TRY(status);
    TRY(walked.status());
    TRY(committed);
    // Its numbers may be the highest ones, and no row remembers them.
    if (!walked.value() && report.catalogue_new)
        return failure(Fault::kIoError,
                       "a day's folder cannot be listed, and there is no catalogue to tell its numbers; "
                       "check the card, or who owns the folder");
    return all && walked.value();
}

Status end_interrupted(Medium& medium, Catalogue& catalogue, const ReadingDesk& desk, const ShortText<159>& cause,
                       StartReport& report)
{
    std::array<StorePath, kMostLeftOvers> names;
    std::size_t count = 0;
    const Errno listed = medium.list(kIncoming, [&](const MediumEntry& entry) {
        if (entry.name.size() <= kLongestName) // dicot made none that is longer
            names[count++] = entry.name;
        return count < kMostLeftOvers;
    });
    TRY(on_card(listed, kIncoming, "listing it"));
    std::sort(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(count),
              [](const StorePath& a, const StorePath& b) { return a.view() < b.view(); });
    for (std::size_t i = 0; i < count; ++i)
        if (!end_one(medium, catalogue, names[i], desk, cause, report).ok())
            ++report.left_over;
    return {};
}

Result<std::int64_t> last_sequence_of(Medium& medium, Catalogue& catalogue)
{
    std::int64_t last = TRY(catalogue.last_sequence());
    TRY(for_each_folder(medium, [&](const StorePath&, const SnapshotName& name) {
        last = std::max(last, name.sequence);
        return true;
    }));
    for (const char* const folder : {kIncoming, kLeaving, kQuarantine})
        last = std::max(last, TRY(highest_name(medium, folder)));
    return last;
}

Status quarantine(Medium& medium, const StorePath& path)
{
    constexpr int kMostNames = 1000;
    const std::size_t slash = path.view().rfind('/');
    const std::string_view leaf = slash == std::string_view::npos ? path.view() : path.view().substr(slash + 1);
    StorePath target = join(kQuarantine, leaf);
    Errno moved = EEXIST;
    for (int k = 2; k < kMostNames; ++k) {
        moved = medium.rename(path.c_str(), target.c_str());
        if (moved.number() != EEXIST)
            break;
        char end[16];
        std::snprintf(end, sizeof end, ".%d", k);
        target = (std::string(join(kQuarantine, leaf).view()) + end).c_str();
    }
    return on_card(moved, path.c_str(), "moving it to quarantine");
}

int count_quarantine(Medium& medium)
{
    int count = 0;
    (void)medium.list(kQuarantine, [&](const MediumEntry&) { return ++count, true; });
    return count;
}

void keep_ballast(Medium& medium, std::uint64_t reserve_bytes)
{
    MediumSpace space;
    if (is_there(medium, kBallast) || !medium.space(space).ok() || space.free_bytes < reserve_bytes + 4 * kBallastBytes)
        return;
    const std::array<std::byte, 16 * 1024> zeros{};
    CardFile file(medium);
    Status status = file.create(kBallast);
    for (std::uint64_t bytes = 0; status.ok() && bytes < kBallastBytes; bytes += zeros.size())
        status = file.write(zeros);
    if (!status.ok())
        (void)medium.remove_file(kBallast);
}

bool release_ballast(Medium& medium)
{
    return medium.remove_file(kBallast).ok();
}

} // namespace dicot
