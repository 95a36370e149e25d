#include "board_health.h"

#include "dicot/base/utc_time.h"

#include <algorithm>
#include <map>

namespace dicot::app {
namespace {

constexpr std::int64_t kDayUs = std::int64_t{86'400} * 1'000'000;

std::optional<double> median_of(std::vector<double>& values)
{
    if (values.empty())
        return std::nullopt;
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 != 0 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

struct DayFigures
{
    int done = 0, missed = 0;
    std::vector<double> luma, focus, epipolar_px, fill;

    void add(const HealthFigures& figures)
    {
        if (figures.left.luma && figures.right.luma)
            luma.push_back((*figures.left.luma + *figures.right.luma) / 2);
        if (figures.left.focus && figures.right.focus)
            focus.push_back(std::min(*figures.left.focus, *figures.right.focus));
        if (figures.epipolar)
            epipolar_px.push_back(figures.epipolar->median_px);
        if (figures.fill)
            fill.push_back(*figures.fill);
    }
    HealthDay told(const std::string& day)
    {
        return {day, done, missed, median_of(luma), median_of(focus), median_of(epipolar_px), median_of(fill)};
    }
};

/// "after 12.5 s" and "after 13 s" are one reason.
std::string without_figures(std::string_view reason)
{
    std::string kind;
    for (const char letter : reason)
        if ((letter >= '0' && letter <= '9') || (letter == '.' && kind.ends_with('#'))) {
            if (!kind.ends_with('#'))
                kind += '#';
        } else {
            kind += letter;
        }
    return kind;
}

class Misses
{
public:
    void add(const SlotRow& row)
    {
        HealthMiss& miss = kinds_[without_figures(row.reason.view())];
        ++miss.count;
        miss.reason = row.reason.view();
        miss.newest = row.sequence;
    }
    std::vector<HealthMiss> most_frequent_first() const
    {
        std::vector<HealthMiss> all;
        for (const auto& [kind, miss] : kinds_)
            all.push_back(miss);
        std::stable_sort(all.begin(), all.end(),
                         [](const HealthMiss& a, const HealthMiss& b) { return a.count > b.count; });
        return all;
    }

private:
    std::map<std::string, HealthMiss> kinds_;
};

Result<std::vector<SlotRow>> newest_rows(Catalogue& catalogue)
{
    std::vector<SlotRow> rows;
    SlotQuery query;
    query.last = BoardHealth::kMostSlots;
    TRY(catalogue.for_each(query, [&rows](const SlotRow& row) {
        rows.push_back(row);
        return true;
    }));
    return rows;
}

/// What the newest snapshot has, and what the misses behind it add.
void judge(const HealthHistory& before, const HealthFigures& done, const std::optional<HealthFigures>& missed,
           const HealthHistory& history, HealthFlags& flags)
{
    if (done.done)
        flags = judge_health(before, done);
    if (!missed)
        return;
    for (const HealthFlag& flag : judge_health(history, *missed))
        if (std::none_of(flags.begin(), flags.end(),
                         [&](const HealthFlag& one) { return std::string_view{one.id} == flag.id; }))
            flags.add(flag);
}

} // namespace

std::optional<Severity> BoardHealth::worst() const
{
    std::optional<Severity> most;
    for (const HealthFlag& flag : flags)
        most = most ? std::max(*most, flag.severity) : flag.severity;
    return most;
}

Result<BoardHealth> board_health(ReadStore& store, const StoreRules& rules, const std::string& path)
{
    BoardHealth board;
    board.summary = TRY(store_summary(store, rules, path));
    const std::vector<SlotRow> rows = TRY(newest_rows(*store.catalogue));
    if (rows.empty())
        return board;
    board.newest_slot = rows.back();
    const std::int64_t newest_us = rows.back().began_us;
    const std::int64_t trend_us = newest_us - BoardHealth::kTrendDays * kDayUs;
    const std::int64_t miss_us = newest_us - BoardHealth::kMissDays * kDayUs;
    std::map<std::string, DayFigures> days;
    Misses misses;
    HealthHistory before, history;
    std::optional<HealthFigures> missed; // since the newest snapshot
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const SlotRow& row = rows[i];
        const bool is_recent = row.began_us >= trend_us;
        const bool is_history = i + 2 * HealthHistory::kMost >= rows.size();
        if (row.began_us >= miss_us) {
            ++board.slots;
            board.missed += row.done ? 0 : 1;
            if (!row.done)
                misses.add(row);
        }
        if (!is_recent && !is_history)
            continue;
        DayFigures aside;
        DayFigures& day = is_recent ? days[utc_day(row.began_us).c_str()] : aside;
        ++(row.done ? day.done : day.missed);
        std::optional<HealthFigures> figures = read_figures(*store.medium, row, history);
        if (!figures) {
            board.unread += row.kept == Kept::kHere ? 1 : 0;
            continue;
        }
        figures->done = row.done;
        if (row.done) {
            day.add(*figures);
            before = history;
            board.newest = figures;
            missed.reset();
        } else {
            missed = figures;
        }
        // The judgement of a miss counts those before it, and itself.
        if (row.done || i + 1 < rows.size())
            history.add(*figures);
    }
    if (board.newest && !board.newest->card.room_mib)
        board.newest->card = card_health(*store.medium, *store.catalogue, rules.reserve_bytes);
    judge(before, board.newest.value_or(HealthFigures{}), missed, history, board.flags);
    board.misses = misses.most_frequent_first();
    for (auto& [day, figures] : days)
        board.trend.push_back(figures.told(day));
    if (board.trend.size() > static_cast<std::size_t>(BoardHealth::kTrendDays))
        board.trend.erase(board.trend.begin(), board.trend.end() - BoardHealth::kTrendDays);
    return board;
}

} // namespace dicot::app
