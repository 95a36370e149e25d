// The names in a store's folder, as the store writes them and nobody else's.
#pragma once

#include "dicot/base/short_text.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace dicot {

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
/// Only what snapshot_name() writes.
std::optional<SnapshotName> parse_snapshot_name(std::string_view text);

/// Whether it is the name of a day's folder: "2026-06-01", a day that exists.
bool is_day_name(std::string_view text);

/// Letters, digits, '.', '_' and '-', 31 at most, not beginning with '.'.
bool is_file_name(std::string_view text);

} // namespace dicot
