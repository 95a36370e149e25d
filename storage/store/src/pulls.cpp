#include "pulls.h"

#include "pulled_mark.h"
#include "snapshot_folder.h"

#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <optional>

namespace dicot {
namespace {

StorePath part_of(const SlotRow& row)
{
    char name[32];
    std::snprintf(name, sizeof name, "%s-%" PRId64, kPulledMark, row.sequence);
    return join(kIncoming, name);
}

Result<SlotRow> pulled_row(Catalogue& catalogue, const Pull& pull)
{
    const std::optional<SlotRow> row = TRY(catalogue.find(pull.sequence));
    if (!row || row->kept != Kept::kHere)
        return failure(Fault::kNoInput, "there is no snapshot %" PRId64, pull.sequence);
    if (row->sums != pull.sums)
        return failure(Fault::kBadData,
                       "snapshot %" PRId64 " has other digests than those that the host has; pull it again",
                       pull.sequence);
    return *row;
}

Status write_part(Medium& medium, const SlotRow& row, std::int64_t pulled_us)
{
    const StorePath part = part_of(row);
    (void)medium.remove_file(part.c_str());
    const PulledText text = print_pulled({pulled_us, row.sums});
    return write_file(medium, part, std::as_bytes(std::span(text.view())));
}

Status place_part(Medium& medium, const SlotRow& row)
{
    const StorePath part = part_of(row);
    const StorePath target = join(folder_of(row).view(), kPulledMark);
    const Errno moved = medium.rename(part.c_str(), target.c_str());
    if (moved.number() != EEXIST)
        return on_card(moved, target.c_str(), "renaming");
    (void)medium.remove_file(part.c_str()); // an earlier pull stands
    return {};
}

} // namespace

Status mark_pulls(Medium& medium, Catalogue& catalogue, std::span<const Pull> pulls)
{
    for (const Pull& pull : pulls)
        TRY(pulled_row(catalogue, pull));
    for (const Pull& pull : pulls) {
        const SlotRow row = TRY(pulled_row(catalogue, pull));
        TRY(write_part(medium, row, pull.pulled_us));
    }
    TRY(on_card(medium.sync_all(), kIncoming, "syncing"));
    for (const Pull& pull : pulls) {
        const SlotRow row = TRY(pulled_row(catalogue, pull));
        TRY(place_part(medium, row));
    }
    TRY(on_card(medium.sync_all(), "", "syncing"));
    for (const Pull& pull : pulls) {
        SlotRow row = TRY(pulled_row(catalogue, pull));
        row.pulled_us = pulled_time(medium, folder_of(row), row.sums);
        if (!row.pulled_us)
            return failure(Fault::kIoError,
                           "%s/%s: the mark of the pull cannot be read; dicot verify --repair mends it",
                           folder_of(row).c_str(), kPulledMark);
        TRY(catalogue.put(row));
    }
    return {};
}

Status restore_mark(Medium& medium, const SlotRow& row)
{
    if (!row.pulled_us)
        return {};
    TRY(write_part(medium, row, *row.pulled_us));
    TRY(on_card(medium.sync_all(), kIncoming, "syncing"));
    TRY(place_part(medium, row));
    return on_card(medium.sync_all(), "", "syncing");
}

} // namespace dicot
