#include "live_coverage.h"

#include "../report_measures.h"

#include <algorithm>
#include <cstdio>

namespace dicot::app {
namespace {

using calibration::kDistanceBins;
using calibration::Stance;
using calibration::WorkingRange;

/// The first of `counts` that is 0.
template <std::size_t count>
std::optional<std::size_t> first_missing(const std::array<int, count>& counts)
{
    const auto found = std::ranges::find(counts, 0);
    return found == counts.end() ? std::nullopt : std::optional{static_cast<std::size_t>(found - counts.begin())};
}

std::optional<std::size_t> first_empty_part(const calibration::Coverage& coverage)
{
    for (std::size_t part = 0; part < kPartNames.size(); ++part)
        if (part_is_empty(coverage, part))
            return part;
    return {};
}

std::string distance_wish(const WorkingRange& range, std::size_t bin, const std::optional<Stance>& now)
{
    const double third_mm = (range.far_mm - range.near_mm) / kDistanceBins;
    const double from_mm = range.near_mm + static_cast<double>(bin) * third_mm;
    char words[120];
    if (now && distance_bin(range, now->distance_mm) == bin)
        std::snprintf(words, sizeof words, "as far away as it is");
    else if (now)
        std::snprintf(words, sizeof words, "%s (%.0f to %.0f mm, now about %.0f mm)",
                      now->distance_mm > from_mm ? "nearer" : "farther", from_mm, from_mm + third_mm, now->distance_mm);
    else
        std::snprintf(words, sizeof words, "at %.0f to %.0f mm", from_mm, from_mm + third_mm);
    return words;
}

} // namespace

bool LiveCoverage::full() const
{
    return !first_empty_part(left) && !first_empty_part(right) && !first_missing(by_distance) &&
           !first_missing(by_edge);
}

std::optional<std::size_t> distance_bin(const WorkingRange& range, double distance_mm)
{
    const double share = (distance_mm - range.near_mm) / (range.far_mm - range.near_mm);
    if (!(share >= 0 && share <= 1))
        return {};
    return static_cast<std::size_t>(std::min(static_cast<int>(share * kDistanceBins), kDistanceBins - 1));
}

void add_pair(LiveCoverage& coverage, const Stance& stance, const WorkingRange& range)
{
    if (const auto bin = distance_bin(range, stance.distance_mm))
        ++coverage.by_distance[*bin];
    const auto count = [&](NearEdge edge, double slope) {
        coverage.by_edge[static_cast<std::size_t>(edge)] += slope >= kLeastSlope ? 1 : 0;
    };
    count(NearEdge::kLeft, stance.slope.x);
    count(NearEdge::kRight, -stance.slope.x);
    count(NearEdge::kUpper, stance.slope.y);
    count(NearEdge::kLower, -stance.slope.y);
}

std::string next_place(const LiveCoverage& coverage, const WorkingRange& range, const std::optional<Stance>& now)
{
    std::string words;
    const auto add = [&](const std::string& wish) { words += (words.empty() ? "" : ", ") + wish; };
    if (const auto bin = first_missing(coverage.by_distance))
        add(distance_wish(range, *bin, now));
    if (const auto part = first_empty_part(coverage.left))
        add(std::string("at the ") + kPartNames[*part] + " of the left picture");
    else if (const auto other = first_empty_part(coverage.right))
        add(std::string("at the ") + kPartNames[*other] + " of the right picture");
    if (const auto edge = first_missing(coverage.by_edge))
        add(std::string("with its ") + kEdgeNames[*edge] + " edge nearer to the cameras than its " +
            kEdgeNames[*edge ^ 1U] + " one");
    return words.empty() ? "elsewhere: another place, distance or tilt" : words;
}

} // namespace dicot::app
