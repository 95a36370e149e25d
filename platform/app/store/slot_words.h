// One slot, for people and for programs.
#pragma once

#include "dicot/catalogue/catalogue.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dicot::app {

/// "done"; "pruned", "quarantine", "lost" where its folder is not in its place; "missed", and "missed, away" likewise.
const char* state_of(const SlotRow& row) noexcept;

/// A line of a table below slot_heading(), without its end.
std::string slot_line(const SlotRow& row);
std::string slot_heading();

nlohmann::json slot_json(const SlotRow& row);

/// JSON for a stream whose reader may be a terminal: printable ASCII in `indent` blanks a level, or one line (-1).
std::string json_text(const nlohmann::json& value, int indent = 2);

/// What a day or a time on the command line covers, both ends included.
struct TimeSpan
{
    std::int64_t first_us, last_us; ///< since 1970, UTC
};

/// 2026-06-01, 2026-06-01T12:30 or 2026-06-01T12:30:15, with or without a Z; always UTC.
std::optional<TimeSpan> parse_time(std::string_view text);

/// The slots between what --since and --until say; empty: no bound. Fault::kUsage: one of them is no time.
Result<SlotQuery> query_between(const std::string& since, const std::string& until);

} // namespace dicot::app
