// What stands where in a store's folder.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/catalogue/catalogue.h"
#include "dicot/record/record.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace dicot {

using StorePath = ShortText<127>;

inline constexpr const char* kIncoming = "incoming";     ///< snapshots that are being written
inline constexpr const char* kLeaving = "leaving";       ///< snapshots that are being deleted
inline constexpr const char* kQuarantine = "quarantine"; ///< what was damaged
inline constexpr const char* kBallast = "ballast";       ///< room for the record of a miss on a full card
inline constexpr const char* kWriting = "writing"; ///< there while a process writes: left behind, it was interrupted
inline constexpr const char* kRecord = "record.json";
inline constexpr const char* kSums = "SHA256SUMS";
inline constexpr const char* kPulledMark = "PULLED";

struct SnapshotName
{
    std::int64_t sequence = 0;
    std::int64_t began_us = 0; ///< whole seconds

    friend bool operator==(const SnapshotName&, const SnapshotName&) = default;
};

/// "000017_20260601T120000Z": six digits or more, as few as possible.
ShortText<31> snapshot_name(const SnapshotName& name);
/// A row that knows no more than the name.
SlotRow row_named(const SnapshotName& name);
/// Only what snapshot_name() writes.
std::optional<SnapshotName> parse_snapshot_name(std::string_view text);

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

/// Whether it is the name of a day's folder: "2026-06-01", a day that exists.
bool is_day_name(std::string_view text);

/// Letters, digits, '.', '_' and '-', 31 at most, not beginning with '.'.
bool is_file_name(std::string_view text);

/// Where a row's snapshot stands, or stood.
StorePath folder_of(const SlotRow& row);

/// "a/b"; "b" if `a` is empty.
StorePath join(std::string_view a, std::string_view b);

} // namespace dicot
