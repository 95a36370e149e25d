// A board's plants over the days: each trait as a series, and what interrupted it.
#pragma once

#include "plant_lives.h"
#include "trait_columns.h"

#include "dicot/os/memory_block.h"
#include "dicot/plant/growth.h"

#include <cstdint>
#include <string>
#include <vector>

namespace dicot::app {

/// Days since the local midnight before the first slot, in seconds that really went by.
class DayCount
{
public:
    DayCount() = default;
    explicit DayCount(const BoardTraits& board);

    double day_of(std::int64_t utc_us) const;
    std::int64_t utc_us(double day) const;
    double hour_of(std::int64_t utc_us) const; ///< of the local day, 0 .. 24
    std::int64_t local_us(std::int64_t utc_us) const { return zone_.local_us(utc_us); }

private:
    TimeZone zone_;
    std::int64_t midnight_us_ = 0;
};

/// Whether a row says when it was.
bool is_dated(const SlotRow& row);

struct TraitSeries
{
    const PlantColumn* column = nullptr;
    std::vector<GrowthSample> samples; ///< one for each sighting; NaN where the clock was not set
    GrowthFit fit;                     ///< of `memory`
    MemoryBlock memory;
};

struct PlantGrowth
{
    PlantLife life;
    std::vector<TraitSeries> series; ///< of those traits that were ever measured
};

/// Slots without traits between two that have some, or before the first, or after the last.
struct SeriesGap
{
    bool dated = false;                  ///< whether any slot of its board says when it was
    std::int64_t from_us = 0, to_us = 0; ///< of the slots around it; where dated
    std::int64_t slots = 0;
    std::string reason; ///< the most frequent one, and how many had another
};

struct BoardGrowth
{
    DayCount days;
    std::vector<PlantGrowth> plants;
    std::vector<SeriesGap> gaps;
};

/// Errors: those of follow_lives() and fit_growth().
Result<BoardGrowth> board_growth(const BoardTraits& board, std::span<const PlantPlace> places);

} // namespace dicot::app
