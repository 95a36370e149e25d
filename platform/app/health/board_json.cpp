#include "board_health.h"

#include "../store/slot_words.h"

#include <nlohmann/json.hpp>

namespace dicot::app {
namespace {

using nlohmann::json;

json known(const std::optional<double>& figure)
{
    return figure ? json(*figure) : json();
}

json trend_json(const std::vector<HealthDay>& days)
{
    json all = json::array();
    for (const HealthDay& day : days)
        all.push_back({{"day", day.day},
                       {"done", day.done},
                       {"missed", day.missed},
                       {"luma", known(day.luma)},
                       {"focus", known(day.focus)},
                       {"epipolar_px", known(day.epipolar_px)},
                       {"fill", known(day.fill)}});
    return all;
}

json misses_json(const BoardHealth& board)
{
    json reasons = json::array();
    for (const HealthMiss& miss : board.misses)
        reasons.push_back({{"reason", miss.reason}, {"count", miss.count}, {"newest", miss.newest}});
    return {{"days", BoardHealth::kMissDays}, {"slots", board.slots}, {"missed", board.missed}, {"reasons", reasons}};
}

} // namespace

json board_json(const BoardHealth& board)
{
    const std::optional<Severity> worst = board.worst();
    return {{"state", worst ? name_of(*worst) : "well"},
            {"newest_slot", board.newest_slot ? slot_json(*board.newest_slot) : json()},
            {"newest_snapshot", board.newest ? json(board.newest->sequence) : json()},
            {"figures", board.newest ? figures_json(*board.newest) : json()},
            {"flags", flags_json(board.flags)},
            {"misses", misses_json(board)},
            {"trend", trend_json(board.trend)},
            {"records_unread", board.unread},
            {"store", summary_json(board.summary)}};
}

} // namespace dicot::app
