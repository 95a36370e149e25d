#include "growth_series.h"

#include "../store/shown.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace dicot::app {
namespace {

constexpr double kDayUs = 86'400e6;
constexpr double kHourUs = 3600e6;

Result<TraitSeries> series_of(const BoardTraits& board, const PlantLife& life, const PlantColumn& column,
                              const DayCount& days)
{
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    TraitSeries series;
    series.column = &column;
    for (const Sighting& seen : life.seen) {
        const SlotTraits& slot = board.slots[seen.slot];
        GrowthSample& sample = series.samples.emplace_back();
        sample.measured = slot.traits->plants[seen.index].traits.*column.measured;
        sample.day = days.day_of(slot.row.began_us);
        sample.hour = days.hour_of(slot.row.began_us);
        if (!is_dated(slot.row))
            sample.measured = {kNone, kNone};
    }
    const GrowthRules rules;
    series.memory = TRY(MemoryBlock::map(growth_bytes(series.samples.size(), rules)));
    Arena arena{series.memory.bytes()};
    series.fit = TRY(fit_growth(series.samples, rules, arena));
    return series;
}

class Gaps
{
public:
    /// The time of what stands around the slots that are missing; a slot without a date has none.
    void slot(const SlotTraits& slot)
    {
        if (last_number_ > 0 && slot.row.sequence > last_number_ + 1)
            missing(slot.row.sequence - last_number_ - 1, "not in this archive");
        last_number_ = slot.row.sequence;
        const std::int64_t at_us = slot.row.due_us.value_or(slot.row.began_us);
        if (!slot.traits)
            missing(1, slot.gap);
        if (!is_dated(slot.row))
            return;
        if (!from_known_)
            from_us_ = at_us;
        from_known_ = true;
        last_us_ = at_us;
        if (slot.traits) {
            close(at_us);
            from_us_ = at_us;
        }
    }

    std::vector<SeriesGap> end()
    {
        close(last_us_);
        return std::move(gaps_);
    }

private:
    void missing(std::int64_t slots, const std::string& reason)
    {
        reasons_[reason] += slots;
        slots_ += slots;
    }

    void close(std::int64_t to_us)
    {
        if (slots_ == 0)
            return;
        const auto most = std::ranges::max_element(reasons_, {}, [](const auto& reason) { return reason.second; });
        std::string words = most->first;
        if (most->second < slots_)
            words += " (" + std::to_string(slots_ - most->second) + " for other reasons)";
        gaps_.push_back({from_known_, from_us_, to_us, slots_, words});
        reasons_.clear();
        slots_ = 0;
    }

    std::vector<SeriesGap> gaps_;
    std::map<std::string, std::int64_t> reasons_;
    std::int64_t slots_ = 0, last_number_ = 0, from_us_ = 0, last_us_ = 0;
    bool from_known_ = false;
};

} // namespace

bool is_rate_known(const GrowthPoint& point)
{
    return point.rate_per_day.sd < std::fabs(point.value.value);
}

bool is_dated(const SlotRow& row)
{
    return row.clock_trust.view() != "not set";
}

DayCount::DayCount(const BoardTraits& board) : zone_(board.zone)
{
    const auto first = std::ranges::find_if(board.slots, [](const SlotTraits& slot) { return is_dated(slot.row); });
    if (first != board.slots.end())
        midnight_us_ = zone_.utc_us(zone_.local_day(first->row.began_us), 0);
}

double DayCount::day_of(std::int64_t utc_us) const
{
    return static_cast<double>(utc_us - midnight_us_) / kDayUs;
}

std::int64_t DayCount::utc_us(double day) const
{
    return midnight_us_ + std::llround(day * kDayUs);
}

double DayCount::hour_of(std::int64_t utc_us) const
{
    const std::int64_t local = zone_.local_us(utc_us);
    const std::int64_t midnight = zone_.local_day(utc_us) * static_cast<std::int64_t>(kDayUs);
    return static_cast<double>(local - midnight) / kHourUs;
}

Result<BoardGrowth> board_growth(const BoardTraits& board, std::span<const PlantPlace> places)
{
    BoardGrowth growth;
    growth.days = DayCount(board);
    for (PlantLife& life : TRY(follow_lives(board, places))) {
        PlantGrowth plant;
        for (const PlantColumn& column : plant_columns()) {
            TraitSeries series = TRY(series_of(board, life, column, growth.days));
            if (series.fit.used > 0)
                plant.series.push_back(std::move(series));
        }
        plant.life = std::move(life);
        growth.plants.push_back(std::move(plant));
    }
    Gaps gaps;
    for (const SlotTraits& slot : board.slots)
        gaps.slot(slot);
    growth.gaps = gaps.end();
    return growth;
}

} // namespace dicot::app
