// What stands where in a store's folder.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/catalogue/catalogue.h"
#include "dicot/record/record.h"
#include "dicot/store/snapshot_name.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace dicot {

using StorePath = ShortText<127>;

inline constexpr const char* kIncoming = "incoming";     ///< snapshots that are being written
inline constexpr const char* kLeaving = "leaving";       ///< snapshots that are being deleted
inline constexpr const char* kQuarantine = "quarantine"; ///< what was damaged

/// What stands in an archive on a computer: it is no store to write to.
inline constexpr const char* kArchiveMark = "ARCHIVE";
inline constexpr const char* kBoardFile = "BOARD";
inline constexpr const char* kLastPullFile = "LAST_PULL";
inline constexpr const char* kBallast = "ballast"; ///< room for the record of a miss on a full card
inline constexpr const char* kWriting = "writing"; ///< there while a process writes: left behind, it was interrupted

/// A row that knows no more than the name.
SlotRow row_named(const SnapshotName& name);
/// A snapshot that is being written: its name tells when it was planned, as nothing else of it may last.
struct PartName
{
    SnapshotName name;
    std::optional<std::int64_t> due_us; ///< whole seconds

    friend bool operator==(const PartName&, const PartName&) = default;
};

/// "000017_20260601T120000Z", or "000017_20260601T120000Z_20260601T115930Z" of one that was planned.
ShortText<63> part_name(const PartName& part);
/// Only what part_name() writes.
std::optional<PartName> parse_part_name(std::string_view text);

/// Where a row's snapshot stands, or stood.
StorePath folder_of(const SlotRow& row);

/// "a/b"; "b" if `a` is empty.
StorePath join(std::string_view a, std::string_view b);

} // namespace dicot
