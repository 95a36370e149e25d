// What record.json says that the catalogue must know.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace dicot {

inline constexpr const char* kRecordFormat = "dicot record 1";
inline constexpr std::size_t kMaxRecordBytes = std::size_t{256} << 10;
inline constexpr std::int64_t kMaxSequence = 999'999'999; ///< nine digits in a folder's name
inline constexpr std::int64_t kMaxRecordPoints = (std::int64_t{1} << 32) - 1;

struct RecordFacts
{
    std::int64_t sequence = 0;          ///< "sequence"
    std::int64_t began_us = 0;          ///< "time"
    std::optional<std::int64_t> due_us; ///< "due"
    bool done = false;                  ///< "outcome": "done" or "missed"
    ShortText<255> reason;              ///< "reason", made printable (dicot/base/printable.h), cut
    ShortText<31> clock_trust;          ///< "clock": {"trust"}
    std::int64_t points = 0;            ///< "cloud": {"points"}

    friend bool operator==(const RecordFacts&, const RecordFacts&) = default;
};

/// Whoever wrote it. `heap` is lent to the reader for the call (kRecordHeapBytes suffice). Fault::kBadData with `name`:
/// no JSON, another format, a key that is missing, twice, of another type or out of its range, nesting beyond 32, more
/// than kMaxRecordBytes.
Result<RecordFacts> read_record(std::span<const std::byte> text, const char* name, std::span<std::byte> heap);
/// Measured: one string as long as a record may be takes 1142 KiB.
inline constexpr std::size_t kRecordHeapBytes = std::size_t{3} << 19;

/// The record of a slot that nobody could finish, into `into`; how many bytes, at most kMaxPlainRecordBytes. 0: it does
/// not fit. Of the times, whole seconds.
std::size_t write_plain_record(const RecordFacts& facts, const char* software, std::span<char> into);
inline constexpr std::size_t kMaxPlainRecordBytes = 2048;

} // namespace dicot
