#include "live_words.h"

#include "../report_measures.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>

namespace dicot::app {
namespace {

constexpr std::array<const char*, calibration::kDistanceBins> kThirds{"near", "middle", "far"};
constexpr const char* kBold = "\033[1m";
constexpr const char* kPlain = "\033[0m";
constexpr int kFewestColumns = 40;

/// One row of the nine parts of a picture: # covered, . not yet.
std::string part_row(const calibration::Coverage& coverage, std::size_t row)
{
    std::string marks;
    for (std::size_t part = 3 * row; part < 3 * row + 3; ++part)
        marks += part_is_empty(coverage, part) ? '.' : '#';
    return marks;
}

std::string bar(int kept, int wanted)
{
    constexpr int kLength = 20;
    const auto full = static_cast<std::size_t>(std::clamp(kLength * kept / std::max(wanted, 1), 0, kLength));
    return std::string(full, '#') + std::string(kLength - full, '.');
}

nlohmann::json missing_parts(const calibration::Coverage& coverage)
{
    return empty_parts(coverage);
}

} // namespace

std::string wrapped(const std::string& text, int columns, int indent)
{
    std::istringstream words(text);
    std::string result;
    std::string word;
    int used = 0;
    while (words >> word) {
        const auto size = static_cast<int>(word.size());
        if (used > 0 && used + 1 + size > columns) {
            result += "\n" + std::string(static_cast<std::size_t>(indent), ' ');
            used = indent;
        } else if (used > 0) {
            result += ' ';
            ++used;
        }
        result += word;
        used += size;
    }
    return result;
}

std::string live_block(const LiveMoment& now, int columns, bool colours)
{
    columns = std::max(columns, kFewestColumns);
    std::array<char, 120> line{};
    std::string block;
    const auto add = [&] { block += std::string(line.data()).substr(0, static_cast<std::size_t>(columns)) + "\n"; };
    std::snprintf(line.data(), line.size(), "%s %d of %d pairs", bar(now.kept, now.wanted).c_str(), now.kept,
                  now.wanted);
    add();
    std::snprintf(line.data(), line.size(), "%-12.12s %4.1f looks/s, skew %+.1f ms, %lld s left", name_of(now.sight),
                  now.looks_per_s, static_cast<double>(now.skew_us) * 1e-3,
                  static_cast<long long>(now.left_us / 1'000'000));
    add();
    std::snprintf(line.data(), line.size(), "left  right  distance  nearer edge");
    add();
    for (std::size_t row = 0; row < kNearEdges; ++row) {
        const bool third = row < kThirds.size();
        std::array<char, 16> distance{};
        if (third)
            std::snprintf(distance.data(), distance.size(), "%-6s %2d", kThirds[row], now.coverage.by_distance[row]);
        std::snprintf(line.data(), line.size(), "%-5s %-6s %-9s %-5s %3d",
                      third ? part_row(now.coverage.left, row).c_str() : "",
                      third ? part_row(now.coverage.right, row).c_str() : "", distance.data(), kEdgeNames[row],
                      now.coverage.by_edge[row]);
        add();
    }
    const std::string advice = wrapped("> " + now.advice, columns, 2);
    block += colours ? kBold + advice + kPlain : advice;
    return block + "\n";
}

std::string live_line(const LiveMoment& now)
{
    return std::to_string(now.kept) + " of " + std::to_string(now.wanted) + " pairs, " + name_of(now.sight) + ": " +
           now.advice;
}

std::string live_json(const LiveMoment& now, const char* event, const std::string& picture)
{
    nlohmann::ordered_json json = {{"event", event},
                                   {"pairs", now.kept},
                                   {"wanted", now.wanted},
                                   {"sight", name_of(now.sight)},
                                   {"advice", now.advice},
                                   {"still_s", static_cast<double>(now.still_us) * 1e-6},
                                   {"skew_us", now.skew_us},
                                   {"looks_per_s", now.looks_per_s},
                                   {"left_s", static_cast<double>(now.left_us) * 1e-6},
                                   {"missing_left", missing_parts(now.coverage.left)},
                                   {"missing_right", missing_parts(now.coverage.right)},
                                   {"boards_by_distance", now.coverage.by_distance},
                                   {"covered", now.coverage.full()}};
    for (std::size_t edge = 0; edge < kNearEdges; ++edge)
        json["nearer_edge"][kEdgeNames[edge]] = now.coverage.by_edge[edge];
    if (!picture.empty())
        json["picture"] = picture;
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace dicot::app
