#include "slot_words.h"

#include "shown.h"

#include "dicot/base/utc_time.h"
#include "dicot/store/store.h"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace dicot::app {
namespace {

using nlohmann::json;

const char* name_of(Kept kept) noexcept
{
    switch (kept) {
    case Kept::kHere:
        return "here";
    case Kept::kPruned:
        return "pruned";
    case Kept::kQuarantined:
        return "quarantine";
    case Kept::kLost:
        break;
    }
    return "lost";
}

json time_json(const std::optional<std::int64_t>& us)
{
    return us ? json(utc_text(*us).view()) : json();
}

constexpr char kLine[] = "%7s  %-20s  %-12s  %8s  %9s  %-10s  %-12s  %s";

} // namespace

const char* state_of(const SlotRow& row) noexcept
{
    const bool here = row.kept == Kept::kHere;
    if (!row.done)
        return here ? "missed" : "missed, away";
    return here ? "done" : name_of(row.kept);
}

std::string slot_heading()
{
    char line[160];
    std::snprintf(line, sizeof line, kLine, "number", "time (UTC)", "state", "points", "size", "pulled", "clock",
                  "reason");
    return line;
}

std::string slot_line(const SlotRow& row)
{
    const std::string clock = shown(row.clock_trust.view());
    char line[320];
    const int length = std::snprintf(
        line, sizeof line, kLine, std::to_string(row.sequence).c_str(), utc_text(row.began_us).c_str(), state_of(row),
        row.done ? std::to_string(row.points).c_str() : "-", shown_bytes(static_cast<double>(row.bytes)).c_str(),
        row.pulled_us ? utc_day(*row.pulled_us).c_str() : "-", clock.c_str(), "");
    std::string text{line, static_cast<std::size_t>(length)};
    text += shown(row.reason.view());
    text.resize(text.find_last_not_of(' ') + 1);
    return text;
}

json slot_json(const SlotRow& row)
{
    json slot = {{"sequence", row.sequence},
                 {"time", utc_text(row.began_us).view()},
                 {"due", time_json(row.due_us)},
                 {"outcome", row.done ? "done" : "missed"},
                 {"reason", row.done ? json() : json(row.reason.view())},
                 {"clock_trust", row.clock_trust.view()},
                 {"points", row.done ? json(row.points) : json()},
                 {"bytes", row.bytes},
                 {"pulled", time_json(row.pulled_us)},
                 {"kept", name_of(row.kept)},
                 {"sums_sha256", row.sums.view()}};
    slot["folder"] = row.kept == Kept::kHere ? json(folder_of(row.sequence, row.began_us).view()) : json();
    return slot;
}

std::string json_text(const json& value, int indent)
{
    return value.dump(indent, ' ', true, json::error_handler_t::replace);
}

std::optional<TimeSpan> parse_time(std::string_view text)
{
    constexpr std::string_view kWhole = "0000-00-00T00:00:00";
    constexpr std::size_t kDay = 10;
    constexpr std::size_t kMinute = 16;
    if (text.size() > kMinute && text.ends_with('Z'))
        text.remove_suffix(1);
    if (text.size() != kDay && text.size() != kMinute && text.size() != kWhole.size())
        return std::nullopt;
    const std::int64_t seconds = text.size() == kDay ? 86'400 : text.size() == kMinute ? 60 : 1;
    const std::optional<std::int64_t> first_us =
        parse_utc_text(std::string{text} + std::string{kWhole.substr(text.size())} + "Z");
    if (!first_us)
        return std::nullopt;
    return TimeSpan{*first_us, *first_us + seconds * 1'000'000 - 1};
}

Result<SlotQuery> query_between(const std::string& since, const std::string& until)
{
    const auto time_of = [](const char* word, const std::string& text) -> Result<TimeSpan> {
        if (const std::optional<TimeSpan> span = parse_time(text))
            return *span;
        return failure(Fault::kUsage, "%s is %s: give a day or a time in UTC, as 2026-06-01 or 2026-06-01T12:30", word,
                       shown(text).c_str());
    };
    SlotQuery query;
    if (!since.empty())
        query.since_us = TRY(time_of("--since", since)).first_us;
    if (!until.empty())
        query.until_us = TRY(time_of("--until", until)).last_us;
    return query;
}

} // namespace dicot::app
