#include "leaving.h"

#include "folder_name.h"
#include "snapshot_folder.h"
#include "start_up.h"

#include "dicot/base/utc_time.h"
#include "dicot/os/stage_watch.h"

#include <array>
#include <cerrno>
#include <utility>

namespace dicot {
namespace {

constexpr std::size_t kBatch = 32;

struct Batch
{
    std::array<SlotRow, kBatch> rows;
    std::size_t count = 0;
};

/// The newest folder that is there: it holds the sequence if the catalogue is lost.
Result<std::int64_t> newest_here(Catalogue& catalogue)
{
    std::int64_t newest = 0;
    TRY(catalogue.for_each({}, [&](const SlotRow& row) {
        if (row.kept == Kept::kHere)
            newest = row.sequence;
        return true;
    }));
    return newest;
}

/// A clock that was not set tells no age.
bool knows_its_age(const SlotRow& row)
{
    return row.clock_trust.view() == "set" || row.clock_trust.view() == "synchronised";
}

/// Whether it is on its way. The row follows when there is room for it again: finish_leaving().
Result<bool> move_aside(Medium& medium, Catalogue& catalogue, SlotRow row)
{
    const StorePath from = folder_of(row);
    const StorePath to = join(kLeaving, snapshot_name({row.sequence, row.began_us}).view());
    const Errno moved = medium.rename(from.c_str(), to.c_str());
    if (moved.number() == ENOENT && !is_there(medium, from.c_str())) { // somebody was quicker
        row.kept = Kept::kLost;
        TRY(catalogue.put(row));
        return false;
    }
    TRY(on_card(moved, from.c_str(), "renaming"));
    return true;
}

/// A row that says so is not enough to delete what nobody may have.
Result<bool> is_pulled(Medium& medium, Catalogue& catalogue, SlotRow row)
{
    const StorePath folder = folder_of(row);
    if (pulled_time(medium, folder, row.sums) || !is_there(medium, folder.c_str()))
        return true;
    EntryKind kind{};
    if (medium.kind_of(join(folder.view(), kPulledMark).c_str(), kind).number() == ENOENT) {
        row.pulled_us = {};
        TRY(catalogue.put(row));
    }
    return false;
}

} // namespace

Result<PruneReport> prune_folders(Medium& medium, Catalogue& catalogue, Prune prune, const PruneWish& wish,
                                  FunctionRef<void(const SlotRow&)> going)
{
    PruneReport report;
    if (prune == Prune::kNever)
        return report;
    MediumSpace space;
    TRY(on_card(medium.space(space), "", "asking for its free space"));
    const std::int64_t newest = TRY(newest_here(catalogue));
    const auto leaves = [&](const SlotRow& row, bool pulled_only) {
        const bool too_old = wish.older_than_us && row.began_us < *wish.older_than_us && knows_its_age(row);
        const bool in_the_way = space.free_bytes + report.bytes < wish.free_bytes;
        return row.kept == Kept::kHere && row.sequence != newest && row.pulled_us.has_value() == pulled_only &&
               (too_old || in_the_way);
    };
    for (const bool pulled_only : {true, false}) {
        if (!pulled_only && prune != Prune::kAll)
            break;
        SlotQuery query;
        for (Batch batch; query.first_sequence = query.first_sequence.value_or(1), true; batch.count = 0) {
            TRY(catalogue.for_each(query, [&](const SlotRow& row) {
                query.first_sequence = row.sequence + 1;
                if (row.kept == Kept::kHere && row.pulled_us.has_value() == pulled_only)
                    batch.rows[batch.count++] = row;
                return batch.count < kBatch;
            }));
            for (std::size_t i = 0; i < batch.count; ++i) {
                const SlotRow& row = batch.rows[i];
                if (!leaves(row, pulled_only) || (pulled_only && !TRY(is_pulled(medium, catalogue, row))))
                    continue;
                StageWatch::progress();
                going(row);
                if (!wish.dry_run && !TRY(move_aside(medium, catalogue, row)))
                    continue;
                ++report.removed;
                report.bytes += static_cast<std::uint64_t>(row.bytes);
            }
            if (batch.count < kBatch)
                break;
        }
    }
    if (report.removed > 0 && !wish.dry_run)
        TRY(finish_leaving(medium, catalogue));
    return report;
}

Status finish_leaving(Medium& medium, Catalogue& catalogue)
{
    std::array<StorePath, kBatch> emptied;
    bool synced = false;
    Status failed;
    for (;;) {
        std::size_t count = 0;
        const Errno listed = medium.list(kLeaving, [&](const MediumEntry& entry) {
            if (entry.kind == EntryKind::kFolder && parse_snapshot_name(entry.name))
                emptied[count++] = entry.name;
            return count < kBatch;
        });
        TRY(on_card(listed, kLeaving, "listing it"));
        if (count == 0)
            return {};
        // What is gone must not come to be missing in its old place.
        if (!std::exchange(synced, true))
            TRY(on_card(medium.sync_all(), kLeaving, "syncing"));
        std::size_t gone = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const SnapshotName name = *parse_snapshot_name(emptied[i].view());
            const StorePath path = join(kLeaving, emptied[i].view());
            const Status status = empty_folder(medium, path);
            if (status.fault() == Fault::kBadData) { // somebody put something in it
                TRY(quarantine(medium, path));
            } else if (!status.ok()) {
                failed = status;
                continue;
            }
            SlotRow row = TRY(catalogue.find(name.sequence)).value_or(row_named(name));
            row.kept = status.ok() ? Kept::kPruned : Kept::kQuarantined;
            (void)medium.remove_folder(utc_day(name.began_us).c_str()); // refused if it was not the last of its day
            if (row.began_us == name.began_us)
                TRY(catalogue.put(row));
            if (status.ok())
                emptied[gone++] = emptied[i];
        }
        // The emptied folder stays until its row is durable.
        TRY(catalogue.sync());
        for (std::size_t i = 0; i < gone; ++i) {
            const StorePath path = join(kLeaving, emptied[i].view());
            TRY(on_card(medium.remove_folder(path.c_str()), path.c_str(), "removing it"));
        }
        if (!failed.ok())
            return failed;
    }
}

} // namespace dicot
