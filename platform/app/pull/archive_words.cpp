#include "archive_words.h"

#include "../store/shown.h"

#include "dicot/base/utc_time.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <vector>

namespace dicot::app {
namespace {

constexpr const char* kOthers = "other reasons";
constexpr std::size_t kMostRanges = 20; ///< in words

std::string shown_ranges(const NumberRanges& ranges)
{
    std::string text;
    for (std::size_t k = 0; k < std::min(ranges.all().size(), kMostRanges); ++k) {
        const NumberRange& range = ranges.all()[k];
        text += (k > 0 ? ", " : "") + std::to_string(range.first);
        if (range.last > range.first)
            text += "-" + std::to_string(range.last);
    }
    if (ranges.all().size() > kMostRanges)
        text += " and " + counted(std::ssize(ranges.all()) - std::int64_t{kMostRanges}, "range") + " more";
    return text;
}

std::vector<std::pair<std::string, std::int64_t>> by_count(const std::map<std::string, std::int64_t>& reasons)
{
    std::vector<std::pair<std::string, std::int64_t>> sorted(reasons.begin(), reasons.end());
    std::ranges::stable_sort(sorted, std::ranges::greater{}, &std::pair<std::string, std::int64_t>::second);
    return sorted;
}

nlohmann::json json_of(const NumberRanges& ranges)
{
    nlohmann::json told = nlohmann::json::array();
    for (const NumberRange& range : ranges.all())
        told.push_back({range.first, range.last});
    return told;
}

} // namespace

void ArchiveSummary::add(const RecordFacts& facts)
{
    if (facts.done)
        return;
    const std::string reason{facts.reason.view()};
    ++reasons[reasons.contains(reason) || reasons.size() < kMostReasons ? reason : std::string{kOthers}];
}

std::string summary_words(const std::string& device, const ArchiveSummary& summary)
{
    const ArchiveLook& look = summary.look;
    std::string text = shown(device) + ": " + counted(look.snapshots, "snapshot") + ", " + std::to_string(look.missed) +
                       " of them missed, " + shown_bytes(static_cast<double>(look.bytes)) + "\n";
    if (look.newest)
        text += "  newest: " + std::to_string(look.newest->sequence) + ", " + utc_text(look.newest->began_us).c_str() +
                "\n";
    for (const auto& [reason, count] : by_count(summary.reasons))
        text += "  missed " + std::to_string(count) + ": " + shown(reason) + "\n";
    if (!look.waiting.empty())
        text += "  not here, and still on the board at the last pull: " + std::to_string(look.waiting.count()) + " (" +
                shown_ranges(look.waiting) + "): dicot pull takes them, --all also those that another computer has\n";
    if (!look.lost.empty())
        text += "  not here, and no longer on the board at the last pull: " + std::to_string(look.lost.count()) + " (" +
                shown_ranges(look.lost) + ")\n";
    if (look.incomplete > 0)
        text += "  half pulled: " + std::to_string(look.incomplete) + ", " +
                shown_bytes(static_cast<double>(look.incomplete_bytes)) + "; the next pull goes on there\n";
    if (look.in_quarantine > 0)
        text += "  damaged here and put aside: " + std::to_string(look.in_quarantine) + " in quarantine/\n";
    text += "  last pull: " + (look.pulled_us ? std::string{utc_text(*look.pulled_us).c_str()} : "not known");
    return text + (look.serial.empty() ? "" : "; serial number " + shown(look.serial)) + "\n";
}

nlohmann::json summary_json(const std::string& device, const ArchiveSummary& summary)
{
    const ArchiveLook& look = summary.look;
    const auto time = [](std::int64_t us) { return nlohmann::json(utc_text(us).c_str()); };
    return {{"device", device},
            {"serial", look.serial},
            {"snapshots", look.snapshots},
            {"missed", look.missed},
            {"missed_by_reason", summary.reasons},
            {"newest", look.newest
                           ? nlohmann::json{{"sequence", look.newest->sequence}, {"time", time(look.newest->began_us)}}
                           : nlohmann::json()},
            {"bytes", look.bytes},
            {"waiting", json_of(look.waiting)},
            {"lost", json_of(look.lost)},
            {"incomplete", look.incomplete},
            {"incomplete_bytes", look.incomplete_bytes},
            {"in_quarantine", look.in_quarantine},
            {"last_pull", look.pulled_us ? time(*look.pulled_us) : nlohmann::json()}};
}

} // namespace dicot::app
