// Times as they stand in files and names.
#pragma once

#include "dicot/base/short_text.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace dicot {

/// Microseconds since 1970, UTC, without leap seconds. The years that text can hold: 0000 .. 9999.
inline constexpr std::int64_t kFirstUtcUs = -62'167'219'200'000'000;
inline constexpr std::int64_t kLastUtcUs = 253'402'300'799'999'999;

using UtcText = ShortText<23>;

/// "2026-03-01T12:00:00Z" (ISO 8601, UTC): the second that the time lies in. Times beyond the years above become the
/// nearest one.
UtcText utc_text(std::int64_t us) noexcept;
/// "20260301T120000Z", for names of files.
UtcText utc_stamp(std::int64_t us) noexcept;
/// "2026-03-01".
UtcText utc_day(std::int64_t us) noexcept;

/// A second that exists, as utc_text() writes it; nothing else.
std::optional<std::int64_t> parse_utc_text(std::string_view text) noexcept;
/// As utc_stamp() writes it.
std::optional<std::int64_t> parse_utc_stamp(std::string_view text) noexcept;

/// Whether `text` is a second that exists, as 2026-03-01T12:00:00Z (ISO 8601, UTC).
inline bool is_utc_time(std::string_view text) noexcept
{
    return parse_utc_text(text).has_value();
}

/// Whether it begins as such a time does: four digits and a hyphen.
bool begins_as_utc_time(std::string_view text) noexcept;

} // namespace dicot
