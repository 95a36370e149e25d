// Times as they stand in files.
#pragma once

#include <string_view>

namespace dicot {

/// Whether `text` is a second that exists, as 2026-03-01T12:00:00Z (ISO 8601, UTC).
bool is_utc_time(std::string_view text);

/// Whether it begins as such a time does: four digits and a hyphen.
bool begins_as_utc_time(std::string_view text);

} // namespace dicot
