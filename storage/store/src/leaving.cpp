#include "leaving.h"

#include "folder_name.h"

#include "dicot/base/utc_time.h"

#include <array>
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
    constexpr std::int64_t kLooked = 256;
    std::int64_t newest = TRY(catalogue.last_sequence());
    SlotQuery query;
    query.last = kLooked;
    TRY(catalogue.for_each(query, [&](const SlotRow& row) {
        if (row.kept == Kept::kHere)
            newest = row.sequence;
        return true;
    }));
    return newest;
}

/// The row follows when there is room for it again: finish_leaving().
Status move_aside(Medium& medium, const SlotRow& row)
{
    const StorePath from = folder_of(row);
    const StorePath to = join(kLeaving, snapshot_name({row.sequence, row.began_us}).view());
    return on_card(medium.rename(from.c_str(), to.c_str()), from.c_str(), "renaming");
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
        const bool too_old = wish.older_than_us && row.began_us < *wish.older_than_us;
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
                if (!leaves(row, pulled_only))
                    continue;
                going(row);
                if (!wish.dry_run)
                    TRY(move_aside(medium, row));
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
        for (std::size_t i = 0; i < count; ++i) {
            const SnapshotName name = *parse_snapshot_name(emptied[i].view());
            TRY(empty_folder(medium, join(kLeaving, emptied[i].view())));
            (void)medium.remove_folder(utc_day(name.began_us).c_str()); // refused if it was not the last of its day
            SlotRow row = TRY(catalogue.find(name.sequence)).value_or(row_named(name));
            if (row.kept != Kept::kPruned && row.began_us == name.began_us) {
                row.kept = Kept::kPruned;
                TRY(catalogue.put(row));
            }
        }
        // The emptied folder stays until its row is durable.
        TRY(catalogue.sync());
        for (std::size_t i = 0; i < count; ++i) {
            const StorePath path = join(kLeaving, emptied[i].view());
            TRY(on_card(medium.remove_folder(path.c_str()), path.c_str(), "removing it"));
        }
    }
}

} // namespace dicot
